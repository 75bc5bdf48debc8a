/*
 * spectral_expand.h: a model's fields, piece by piece, for whoever makes a table of them.
 */
#ifndef MODEL_SPECTRAL_SPECTRAL_EXPAND_H
#define MODEL_SPECTRAL_SPECTRAL_EXPAND_H

#include "spectral.h"

/*
 * Cells column..column + width - 1 of the rows row..row + rows - 1 of phi_d (theta_h * D + theta_d): three fields, rows `stride`
 * apart. May be read up to 15 cells past the last. `alone`: of one row; its other cells, on either side, have the value of the
 * one beside them.
 */
struct spectral_block {
	const float *field[3];
	size_t row, rows;
	uint32_t column, width;
	size_t stride;
	bool alone;
};
typedef void spectral_block_fn(void *user, const struct spectral_block *block);

/* Every cell once, in blocks of SPECTRUM_BLOCK cells of all rows. */
bp_status spectral_expand_blocks(const struct spectral_model *model, uint32_t layers, spectral_block_fn *take, void *user,
                                 bp_error *error);
/* Likewise where rows are cut: all, or the table of every second value, row by row. */
bp_status spectral_expand_rows(const struct spectral_model *model, uint32_t layers, bool half, spectral_block_fn *take,
                               void *user, bp_error *error);
/* The table of every second value, whole rows in their order. The model's extents must be even; decoded models only. */
bp_status spectral_expand_half_blocks(const struct spectral_model *model, uint32_t layers, spectral_block_fn *take, void *user,
                                      bp_error *error);

#endif
