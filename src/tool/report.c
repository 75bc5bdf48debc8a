#include "report.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "not_archive.h"
#include "shown.h"

void (*report_before)(void);
bool report_workers;

/* One line of a message, built whole and written at once, so that lines of several processes do not mix. */
struct line {
	char text[4096];
	size_t used;
};

static void line_add(struct line *line, const char *text)
{
	line->used += shown_text(line->text + line->used, sizeof line->text - line->used - 1, text); /* room for the newline */
}

static void line_add_where(struct line *line, const char *file, const char *material)
{
	line_add(line, "brdfpack: ");
	if (file) {
		line_add(line, file);
		line_add(line, ": ");
	}
	if (material) {
		line_add(line, material);
		line_add(line, ": ");
	}
}

static void line_add_format(struct line *line, const char *format, va_list arguments)
{
	char text[3072];
	vsnprintf(text, sizeof text, format, arguments);
	line_add(line, text);
}

static void line_print(struct line *line)
{
	line->text[line->used++] = '\n';
	if (report_before)
		report_before();
	fwrite(line->text, 1, line->used, stderr);
}

int report_text(const char *format, ...)
{
	struct line line = {.used = 0};
	va_list arguments;
	line_add_where(&line, NULL, NULL);
	va_start(arguments, format);
	line_add_format(&line, format, arguments);
	va_end(arguments);
	line_print(&line);
	return EXIT_FAILED;
}

/* What to do about it, where that does not depend on the case. */
static const char *status_remedy(const bp_error *error)
{
	switch (error->status) {
	case BP_ERROR_UNSUPPORTED: return strstr(error->message, "earlier version") ? NULL : "a newer brdfpack reads it";
	case BP_ERROR_MEMORY: return report_workers ? "close other programs, or use fewer workers (-j)" : "close other programs";
	default: return NULL;
	}
}

void error_describe(const bp_error *error, char *text, size_t bytes)
{
	char kind[64] = "";
	if ((error->status == BP_ERROR_CORRUPT || error->status == BP_ERROR_CHECKSUM) && error->offset != BP_NO_OFFSET)
		snprintf(kind, sizeof kind, "corrupt at offset %" PRIu64, error->offset);
	else if (error->status == BP_ERROR_CORRUPT || error->status == BP_ERROR_CHECKSUM || error->status == BP_ERROR_NOT_OURS ||
	         error->status == BP_ERROR_UNSUPPORTED)
		snprintf(kind, sizeof kind, "%s", bp_status_text(error->status));
	if (strstr(error->message, kind))
		kind[0] = '\0'; /* the message says so itself */
	const char *message = error->message[0] ? error->message : kind[0] ? "" : bp_status_text(error->status);
	const char *remedy = status_remedy(error);
	snprintf(text, bytes, "%s%s%s%s%s", kind, kind[0] && message[0] ? ": " : "", message, remedy ? "; " : "",
	         remedy ? remedy : "");
}

int report_error(const char *file, const char *material, const bp_error *error)
{
	struct line line = {.used = 0};
	char text[1024];
	const char *named = file;
	error_describe(error, text, sizeof text);
	if (file && !material && !strncmp(text, file, strlen(file)) && text[strlen(file)] == ':')
		file = NULL; /* what writes files names them itself */
	line_add_where(&line, file, material);
	line_add(&line, text);
	if (file && !material &&
	    (error->status == BP_ERROR_CORRUPT || error->status == BP_ERROR_CHECKSUM)) /* an archive as a whole */
		line_add(&line, "; `brdfpack recover` saves what is intact");
	if (named && !material && error->status == BP_ERROR_NOT_OURS) {
		not_archive_tell(named, text, sizeof text);
		line_add(&line, text);
	}
	line_print(&line);
	return EXIT_FAILED;
}

void report_warning(const char *file, const char *material, const char *format, ...)
{
	struct line line = {.used = 0};
	va_list arguments;
	line_add_where(&line, file, material);
	line_add(&line, "warning: ");
	va_start(arguments, format);
	line_add_format(&line, format, arguments);
	va_end(arguments);
	line_print(&line);
}

void report_remark(const char *file, const bp_error *error)
{
	if (error->message[0])
		report_warning(file, NULL, "%s", error->message);
}

int report_usage(const struct command *command, const char *format, ...)
{
	struct line line = {.used = 0};
	va_list arguments;
	line_add(&line, "brdfpack ");
	line_add(&line, command->name);
	line_add(&line, ": ");
	va_start(arguments, format);
	line_add_format(&line, format, arguments);
	va_end(arguments);
	line_add(&line, "; see `brdfpack ");
	line_add(&line, command->name);
	line_add(&line, " --help`");
	line_print(&line);
	return EXIT_USAGE;
}

void text_print(const char *text, int width)
{
	char step[SHOWN_STEP_MAX];
	int columns = 0, one;
	for (size_t n; (n = shown_next(&text, step, &one)) > 0; columns += one)
		fwrite(step, 1, n, stdout);
	printf("%*s", columns < width ? width - columns : 0, "");
}
