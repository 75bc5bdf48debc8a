/*
 * canvas.h: lines, text and cell pictures, drawn into a PNG or written as SVG.
 *
 * Coordinates are pixels, (0, 0) is the upper left corner, y points down. Whoever draws does not see which it is.
 */
#ifndef RENDER_CANVAS_H
#define RENDER_CANVAS_H

#include "picture.h"

struct colour {
	uint8_t r, g, b;
};

enum anchor { ANCHOR_LEFT, ANCHOR_MIDDLE, ANCHOR_RIGHT };

struct canvas;

/* A white canvas; svg: text that canvas_write writes, else a picture. The caller frees it with canvas_free. */
bp_status canvas_make(uint32_t width, uint32_t height, bool svg, struct canvas **out, bp_error *error);
void canvas_free(struct canvas *canvas); /* NULL is allowed */

void canvas_rectangle(struct canvas *canvas, double x, double y, double width, double height, struct colour fill);

/* Straight stretches between `count` points; a point with a NaN interrupts the line. */
void canvas_line(struct canvas *canvas, const double (*points)[2], size_t count, double width, struct colour colour);

/* Text of `height` pixels (multiples of 7 look best in PNG) with its baseline at y; upwards: turned a quarter to the left. */
void canvas_text(struct canvas *canvas, double x, double y, double height, enum anchor anchor, bool upwards, struct colour colour,
                 const char *text);

/* A picture stretched over a rectangle of whole pixels, without smoothing. */
void canvas_picture(struct canvas *canvas, uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                    const struct picture *picture);

/* To a file, whole or not at all. Reports an allocation that failed while drawing. */
bp_status canvas_write(struct canvas *canvas, const char *path, bp_error *error);

#endif
