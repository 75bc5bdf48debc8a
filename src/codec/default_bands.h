/*
 * default_bands.h: where the coefficients of one harmonic stand while they are coded.
 *
 * The plane of H x D wavelet coefficients falls into bands (FORMAT.md, "Bands"), the coarse one first, each a padded
 * rectangle: one cell of padding all around, always 0, so that neighbours need no test. A band falls into
 * blocks of 8 x 8, padded likewise.
 */
#ifndef CODEC_DEFAULT_BANDS_H
#define CODEC_DEFAULT_BANDS_H

#include "../model/spectrum.h"

enum { BANDS_MAX = 3 * SPECTRUM_LEVELS_MAX + 1, BLOCK_EDGE = 8 };

struct band {
	uint32_t row, column, rows, columns; /* in the plane of coefficients */
	uint32_t orientation;                /* bit 0: detail along theta_d, bit 1: along theta_h */
	int32_t parent;                      /* the band of the same orientation one level coarser, band 0 at the coarsest level, -1 for band 0 */
	uint32_t parent_shift;               /* 1: a parent's cell stands for 2 x 2; 0 at the coarsest level */
	uint32_t at, stride;                 /* of cell (0, 0) in the padded plane */
	uint32_t block_rows, block_columns, block_at, block_stride;
	uint8_t row_class[LATTICE_EXTENT_MAX], column_class[LATTICE_EXTENT_MAX]; /* place along the band in twelfths */
};

struct bands {
	uint32_t count;
	uint32_t cells, blocks; /* of a padded plane */
	struct band band[BANDS_MAX];
};

void bands_lay_out(uint32_t theta_h, uint32_t theta_d, struct bands *out);

#endif
