/*
 * spectrum_turn.h: the spectrum of the same table with theta_h and theta_d reversed. Where their extents are even, the
 * wavelets' first step pairs each cell with its other neighbour there, so what a step's thresholds do to the one spectrum and
 * to the other differs, and the mean of both is nearer to what was measured (cycle spinning: Coifman and Donoho 1995).
 */
#ifndef MODEL_SPECTRAL_SPECTRUM_TURN_H
#define MODEL_SPECTRAL_SPECTRUM_TURN_H

#include "spectrum.h"

struct spectrum_turn; /* scratch for tables of one size; one thread at a time */

/* spectrum: that of such tables, used by every turn. */
bp_status spectrum_turn_create(struct spectrum *spectrum, struct lattice_dims dims, struct spectrum_turn **out, bp_error *error);
void spectrum_turn_free(struct spectrum_turn *turn); /* NULL is allowed */

/* A spectrum to that of the table turned, which is its own inverse but for rounding; out may be in. */
void spectrum_turned(struct spectrum_turn *turn, const float *in, float *out);

#endif
