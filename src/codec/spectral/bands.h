/*
 * bands.h: the order in which the coefficients of one harmonic are coded.
 *
 * The plane of H x D wavelet coefficients falls into bands (FORMAT.md, "Bands"), the coarse one first, and a band into blocks of
 * 8 x 8 (fewer at its end). Blocks have numbers; around each band's is one block of padding, so that neighbours need no test.
 */
#ifndef CODEC_SPECTRAL_BANDS_H
#define CODEC_SPECTRAL_BANDS_H

#include "model/spectral/spectral.h"

enum { BANDS_MAX = 3 * SPECTRUM_LEVELS_MAX + 1, BLOCK_EDGE = 8 };

struct band {
	uint32_t row, column, rows, columns; /* in the plane of coefficients */
	uint32_t orientation;                /* bit 0: detail along theta_d, bit 1: along theta_h */
	int32_t parent;        /* the band of the same orientation one level coarser, band 0 at the coarsest level, -1 for band 0 */
	uint32_t parent_shift; /* 1: a parent's cell stands for 2 x 2; 0 at the coarsest level */
	uint32_t block_rows, block_columns, block_at, block_stride;
};

struct bands {
	uint32_t count;
	uint32_t blocks; /* of a plane, padding included */
	struct band band[BANDS_MAX];
};

void bands_lay_out(uint32_t theta_h, uint32_t theta_d, struct bands *out);

#endif
