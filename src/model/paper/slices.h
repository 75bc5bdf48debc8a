/*
 * slices.h: the conditional pairs c_dphi|h of one channel, fitted against the coded pairs.
 *
 * First every slice gets an equal share of the coefficients, from the last slice down, each starting from what its neighbour
 * ended with. Then the shares are dealt out anew: the largest gains of all slices are kept, wherever they are.
 */
#ifndef MODEL_PAPER_SLICES_H
#define MODEL_PAPER_SLICES_H

#include "pairs.h"

/* slice: paper_shared_from + 1 fields, zeroed. fit: of the slices' plane. */
bp_status slices_fit(const struct channel_fit *channel, struct sparse_fit *fit, struct sparse_field *slice, bp_error *error);

#endif
