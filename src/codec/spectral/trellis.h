/*
 * trellis.h: the levels of one harmonic, chosen together (the algorithm of Viterbi 1967, over the states of
 * model/spectral/dependent.h).
 *
 * Least is to be the sum of squared errors, in steps, and of the bits that the levels are likely to take, each counted as
 * TRELLIS_BIT. No level is chosen by itself: it decides which values the next ones may have, and one that stands alone costs
 * most.
 */
#ifndef CODEC_SPECTRAL_TRELLIS_H
#define CODEC_SPECTRAL_TRELLIS_H

#include "model/spectral/spectral.h"

#define TRELLIS_BIT 0.09f /* squared steps; VARIANTS.md, "Quantisation and the bits of levels" */

/* A coefficient that may have a level. */
struct trellis_cell {
	uint32_t level; /* in: what the size is near to; out: what was chosen */
	float
		beyond; /* of the size, in steps: in: less level, -0.4 to 0.6; out: less what the level stands for, without its centre */
	uint32_t place;    /* the caller's own */
	uint8_t around;    /* in: levels around it, as a class of trellis_classes */
	uint8_t quantiser; /* out: of a level that is not 0 */
};

/*
 * Before a cell: the least cost of each state; and what the cell's choices cost: 0, an even and an odd level of either
 * quantiser.
 */
struct trellis_costs {
	float of[DEPENDENT_STATES], zero, level[4];
};

/* The class of a sum of sizes around a cell (planes_settle.c). */
enum { TRELLIS_SUMS = 256 };
void trellis_classes(uint8_t class_of[TRELLIS_SUMS]);

/* costs: room for `count`. */
void trellis_choose(struct trellis_cell *cells, uint32_t count, struct trellis_costs *costs);

#endif
