/*
 * fidelity.h: error figures between a measured table and decoded ones.
 */
#ifndef MODEL_FIDELITY_H
#define MODEL_FIDELITY_H

#include "fit.h"
#include "merl/lattice.h"

/* Fidelity of a decoded table against the measured one, over valid cells and the three channels. */
struct fidelity {
	double log_rmse;         /* rms of log10((e + 1e-3)/(b + 1e-3)) */
	double seen_log_rmse;    /* the same over the cells that can be seen (lattice_seen) only; log_rmse where there are none */
	double cube_root_rmse;   /* rms of cbrt(b cos) - cbrt(e cos), cos the smaller cosine at the cell's lower corner */
	double largest_relative; /* largest |e - b|/(b + 1e-2) */
};

/*
 * The figures of `count` tables (1 to LAYERS_MAX), over valid cells of `truth` and three channels: out[count]; e decoded, b
 * measured, in 1/sr. Sums in a fixed order (per theta_h slice, then over slices), so the result is the same on every machine.
 * What depends on the measured value alone is worked out once for all tables, so three take half again as long as one.
 * Negative or non-finite e cannot occur (expansion). BP_ERROR_ARGUMENT where the extents differ, BP_ERROR_BAD_INPUT where no cell
 * is valid.
 */
bp_status fidelity_measure(const struct lattice *truth, const struct expansion *tables, uint32_t count, struct fidelity *out,
                           bp_error *error);

#endif
