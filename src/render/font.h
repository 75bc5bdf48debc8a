/*
 * font.h: a fixed 5 x 7 bitmap font, two more rows for descenders, for labels in PNG pictures.
 */
#ifndef RENDER_FONT_H
#define RENDER_FONT_H

#include <stdint.h>

enum { FONT_WIDTH = 5, FONT_HEIGHT = 7, FONT_ROWS = 9, FONT_ADVANCE = 6 };

/* The glyph of an ASCII character, '?' for others: bit x + 5 y is set where column x, row y (from the top) is ink. */
uint64_t font_glyph(unsigned char character);

#endif
