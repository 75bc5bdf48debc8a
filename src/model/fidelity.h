/*
 * fidelity.h: error figures between a measured table and a decoded one.
 */
#ifndef MODEL_FIDELITY_H
#define MODEL_FIDELITY_H

#include "model.h"

/*
 * Over valid cells of `truth` and three channels; e decoded, b measured, in 1/sr. Sums in a fixed
 * order (per theta_h slice, then over slices), so the result is the same on every machine.
 * Negative or non-finite e cannot occur (expansion).
 */
bp_status fidelity_measure(const struct lattice *truth, const struct expansion *table, struct fidelity *out, bp_error *error);

#endif
