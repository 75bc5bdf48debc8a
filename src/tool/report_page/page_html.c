#include "page_html.h"

#include <stdarg.h>
#include <stdlib.h>

#include "name.h"
#include "render/base64.h"

void html_text(FILE *out, const char *string)
{
	const unsigned char *text = (const unsigned char *)string;
	while (*text) {
		uint32_t code = 0;
		const size_t length = name_character(text, 4, &code);
		switch (*text) {
		case '&': fputs("&amp;", out); break;
		case '<': fputs("&lt;", out); break;
		case '>': fputs("&gt;", out); break;
		case '"': fputs("&quot;", out); break;
		case '\'': fputs("&#39;", out); break;
		default:
			if (length == 0 || code < 0x20 || (code >= 0x7f && code < 0xa0))
				fputs("\xef\xbf\xbd", out);
			else
				fwrite(text, 1, length, out);
		}
		text += length ? length : 1;
	}
}

void html_name(FILE *out, const char *name)
{
	fputs("<bdi>", out);
	html_text(out, name);
	fputs("</bdi>", out);
}

void html_table(FILE *out, const char *caption, ...)
{
	va_list columns;
	fprintf(out, "<table><caption>%s</caption><thead><tr>", caption);
	va_start(columns, caption);
	for (const char *column; (column = va_arg(columns, const char *));)
		fprintf(out, "%s%s", *column ? "<th scope=col>" : "<td>", column);
	va_end(columns);
}

bp_status html_picture(FILE *out, const struct picture *picture, const char *style, const char *alt, bp_error *error)
{
	uint8_t *png;
	size_t bytes;
	bp_status status = picture_encode_png(picture, &png, &bytes, error);
	if (status != BP_OK)
		return status;
	fprintf(out, "<img class=\"%s\" loading=lazy width=%u height=%u alt=\"", style, picture->width, picture->height);
	html_text(out, alt);
	fputs("\" src=\"data:image/png;base64,", out);
	base64_write(out, png, bytes);
	fputs("\">", out);
	free(png);
	return BP_OK;
}
