/*
 * two_halves.h: MERL-like files with 360 cells of phi_d, which runs from 0 to 2 pi there, as measurements that were not made
 * reciprocal are distributed (the PQBA set's, of 69,984,012 bytes). Cells k and k + 180 are a pair of directions exchanged.
 */
#ifndef MERL_TWO_HALVES_H
#define MERL_TWO_HALVES_H

#include "input.h"

/* Of |a - b| / ((a + b) / 2) over the cells that both halves have: what is still taken for one reciprocal material. */
#define TWO_HALVES_MEDIAN_MAX 0.05
#define TWO_HALVES_PERCENTILE95_MAX 0.5

/* Whether a MERL header's extents are these: 90, 90, 360. */
bool two_halves_extents(const int32_t extent[3]);
/* Bytes of such a file. */
uint64_t two_halves_bytes(void);

/*
 * After the header, to the end of the stream: the mean of both halves, on MERL's lattice. A cell needs both. BP_ERROR_BAD_INPUT,
 * with the two figures, where the halves disagree by more than the above.
 */
bp_status two_halves_read(struct input *in, struct lattice *out, struct origin *origin, bp_error *error);

#endif
