/*
 * picture.h: exposed images as 8-bit pictures, and files of both.
 */
#ifndef RENDER_PICTURE_H
#define RENDER_PICTURE_H

#include <stdbool.h>

#include "image.h"

/* 8-bit RGB, interleaved, top row first: what a PNG file holds. */
struct picture {
	uint32_t width, height;
	uint8_t *rgb;
};
bp_status picture_alloc(uint32_t width, uint32_t height, struct picture *out, bp_error *error);
void picture_free(struct picture *picture);

/* Exposed image in sRGB at column x of the picture; values that are not finite become magenta. */
void picture_place(struct picture *picture, uint32_t x, const struct sphere_image *image, double exposure);

/*
 * reference | reconstruction | difference x10, side by side: |a - b| of the two images in sRGB, times 10,
 * in 8 bits.
 */
bp_status picture_compare(const struct sphere_image *reference, const struct sphere_image *estimate, struct picture *out,
                          bp_error *error);

/* The bytes of a PNG file, malloc'ed; the caller frees them. */
bp_status picture_encode_png(const struct picture *picture, uint8_t **bytes, size_t *count, bp_error *error);

/*
 * Whether a file that begins with these bytes is a PNG or an SVG that this program drew: a text chunk, or a comment, says so. A
 * PFM file has no room for that.
 */
#define PICTURE_SVG_MARK "<!-- drawn by brdfpack -->"
bool picture_is_ours(const uint8_t *head, size_t count);

/*
 * Files. An older file is replaced whole or not at all (output_file.h). PFM: RGB float32 little-endian, bottom row first; values
 * are in 1/sr, the scale field -1, but for images of extreme magnitude: those are in units of their own, which the scale field
 * tells (negative).
 */
bp_status picture_write_png(const char *path, const struct picture *picture, bp_error *error);
bp_status image_write_pfm(const char *path, const struct sphere_image *image, bp_error *error);

#endif
