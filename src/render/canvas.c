#include "canvas.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base64.h"
#include "error.h"
#include "font.h"
#include "memory_stream.h"
#include "output_file.h"

struct canvas {
	bool svg;
	uint32_t width, height;
	struct picture picture; /* PNG */
	FILE *text;             /* SVG, into svg_bytes */
	struct byte_buffer svg_bytes;
	bool failed; /* out of memory while drawing */
};

bp_status canvas_make(uint32_t width, uint32_t height, bool svg, struct canvas **out, bp_error *error)
{
	struct canvas *canvas = calloc(1, sizeof *canvas);
	if (!canvas)
		return error_memory(error, sizeof *canvas);
	*canvas = (struct canvas){.svg = svg, .width = width, .height = height};
	bp_status status = BP_OK;
	if (!svg)
		status = picture_alloc(width, height, &canvas->picture, error);
	else if (!(canvas->text = memory_stream_open(&canvas->svg_bytes)))
		status = error_memory(error, BUFSIZ);
	else
		fprintf(canvas->text,
		        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%u\" height=\"%u\" viewBox=\"0 0 %u %u\" "
		        "font-family=\"sans-serif\">\n" PICTURE_SVG_MARK "\n",
		        width, height, width, height);
	if (status) {
		canvas_free(canvas);
		return status;
	}
	canvas_rectangle(canvas, 0, 0, width, height, (struct colour){255, 255, 255});
	*out = canvas;
	return BP_OK;
}

void canvas_free(struct canvas *canvas)
{
	if (canvas) {
		if (canvas->text)
			fclose(canvas->text);
		byte_buffer_free(&canvas->svg_bytes);
		picture_free(&canvas->picture);
		free(canvas);
	}
}

/* Mixes a colour into a pixel; share 0..1. */
static void pixel_mix(struct canvas *canvas, long x, long y, double share, struct colour colour)
{
	if (x < 0 || y < 0 || x >= (long)canvas->width || y >= (long)canvas->height)
		return;
	uint8_t *rgb = canvas->picture.rgb + 3 * ((size_t)x + (size_t)y * canvas->width);
	const uint8_t ink[3] = {colour.r, colour.g, colour.b};
	for (int c = 0; c < 3; c++)
		rgb[c] = (uint8_t)(rgb[c] + (ink[c] - rgb[c]) * share + 0.5);
}

void canvas_rectangle(struct canvas *canvas, double x, double y, double width, double height, struct colour fill)
{
	if (canvas->svg) {
		fprintf(canvas->text, "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"#%02x%02x%02x\"/>\n", x, y, width,
		        height, fill.r, fill.g, fill.b);
		return;
	}
	for (long v = lround(y); v < lround(y + height); v++)
		for (long u = lround(x); u < lround(x + width); u++)
			pixel_mix(canvas, u, v, 1, fill);
}

/* One stretch: every pixel near it gets ink by its distance from the axis, which smooths the edges. */
static void stretch_draw(struct canvas *canvas, const double a[2], const double b[2], double width, struct colour colour)
{
	double half = width / 2, dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
	long x0 = (long)floor(fmin(a[0], b[0]) - half - 1), x1 = (long)ceil(fmax(a[0], b[0]) + half + 1);
	long y0 = (long)floor(fmin(a[1], b[1]) - half - 1), y1 = (long)ceil(fmax(a[1], b[1]) + half + 1);
	for (long y = y0; y <= y1; y++)
		for (long x = x0; x <= x1; x++) {
			double px = (double)x + 0.5 - a[0], py = (double)y + 0.5 - a[1];
			double t = square > 0 ? fmin(1, fmax(0, (px * dx + py * dy) / square)) : 0;
			double share = half + 0.5 - hypot(px - t * dx, py - t * dy);
			if (share > 0)
				pixel_mix(canvas, x, y, fmin(1, share), colour);
		}
}

static bool point_drawn(const double point[2]) { return isfinite(point[0]) && isfinite(point[1]); }

void canvas_line(struct canvas *canvas, const double (*points)[2], size_t count, double width, struct colour colour)
{
	if (!canvas->svg) {
		for (size_t n = 1; n < count; n++)
			if (point_drawn(points[n - 1]) && point_drawn(points[n]))
				stretch_draw(canvas, points[n - 1], points[n], width, colour);
		return;
	}
	fprintf(canvas->text, "<path fill=\"none\" stroke=\"#%02x%02x%02x\" stroke-width=\"%g\" stroke-linejoin=\"round\" d=\"",
	        colour.r, colour.g, colour.b, width);
	for (size_t n = 0; n < count; n++)
		if (point_drawn(points[n]))
			fprintf(canvas->text, "%c%.2f %.2f", n && point_drawn(points[n - 1]) ? 'L' : 'M', points[n][0], points[n][1]);
	fprintf(canvas->text, "\"/>\n");
}

static void text_escape(FILE *out, const char *text)
{
	for (; *text; text++) {
		unsigned char c = (unsigned char)*text;
		if (c == '&' || c == '<' || c == '>' || c == '"')
			fprintf(out, "&#%d;", c);
		else if (c >= 32 && c != 127) /* names are UTF-8; control characters are not legal in XML */
			fputc(c, out);
	}
}

void canvas_text(struct canvas *canvas, double x, double y, double height, enum anchor anchor, bool upwards, struct colour colour,
                 const char *text)
{
	static const char *const ANCHORS[] = {"start", "middle", "end"};
	if (canvas->svg) {
		/* capitals are about 0.72 of the font's size */
		fprintf(canvas->text, "<text x=\"%g\" y=\"%g\" font-size=\"%g\" text-anchor=\"%s\" fill=\"#%02x%02x%02x\"", x, y,
		        height / 0.72, ANCHORS[anchor], colour.r, colour.g, colour.b);
		if (upwards)
			fprintf(canvas->text, " transform=\"rotate(-90 %g %g)\"", x, y);
		fputc('>', canvas->text);
		text_escape(canvas->text, text);
		fprintf(canvas->text, "</text>\n");
		return;
	}
	long scale = lround(fmax(1, height / FONT_HEIGHT)), count = 0;
	for (const char *c = text; *c; c++)
		count += ((unsigned char)*c & 0xc0) != 0x80; /* characters, not bytes, of UTF-8 */
	long width = (count * FONT_ADVANCE - 1) * scale;
	long start = -lround((double)width * (anchor == ANCHOR_LEFT ? 0 : anchor == ANCHOR_MIDDLE ? 0.5 : 1)), along = start;
	for (const char *c = text; *c; c++) {
		if (((unsigned char)*c & 0xc0) == 0x80)
			continue;
		uint64_t glyph = font_glyph((unsigned char)*c);
		for (long n = 0; n < FONT_WIDTH * FONT_ROWS * scale * scale; n++) {
			long u = n % (FONT_WIDTH * scale), v = n / (FONT_WIDTH * scale);
			if (!(glyph >> (u / scale + FONT_WIDTH * (v / scale)) & 1))
				continue;
			long right = along + u, down = v - FONT_HEIGHT * scale;
			pixel_mix(canvas, lround(x) + (upwards ? down : right), lround(y) + (upwards ? -right : down), 1, colour);
		}
		along += FONT_ADVANCE * scale;
	}
}

void canvas_picture(struct canvas *canvas, uint32_t x, uint32_t y, uint32_t width, uint32_t height, const struct picture *picture)
{
	if (canvas->svg) {
		uint8_t *bytes;
		size_t count;
		if (picture_encode_png(picture, &bytes, &count, NULL) != BP_OK) {
			canvas->failed = true;
			return;
		}
		fprintf(canvas->text,
		        "<image x=\"%u\" y=\"%u\" width=\"%u\" height=\"%u\" preserveAspectRatio=\"none\" "
		        "style=\"image-rendering:pixelated\" href=\"data:image/png;base64,",
		        x, y, width, height);
		base64_write(canvas->text, bytes, count);
		fprintf(canvas->text, "\"/>\n");
		free(bytes);
		return;
	}
	for (uint32_t v = 0; v < height; v++)
		for (uint32_t u = 0; u < width; u++) {
			size_t column = (size_t)u * picture->width / width, row = (size_t)v * picture->height / height;
			const uint8_t *rgb = picture->rgb + 3 * (column + row * picture->width);
			pixel_mix(canvas, (long)(x + u), (long)(y + v), 1, (struct colour){rgb[0], rgb[1], rgb[2]});
		}
}

bp_status canvas_write(struct canvas *canvas, const char *path, bp_error *error)
{
	if (!canvas->svg)
		return picture_write_png(path, &canvas->picture, error);
	fprintf(canvas->text, "</svg>\n");
	if (fflush(canvas->text) != 0 || canvas->svg_bytes.failed || canvas->failed)
		return error_memory(error, canvas->svg_bytes.count);
	return output_file_write_whole(path, OUTPUT_REPLACE, canvas->svg_bytes.bytes, canvas->svg_bytes.count, error);
}
