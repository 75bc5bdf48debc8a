/*
 * dependent.h: which of two quantisers a level is of (trellis-coded quantisation: Marcellin and Fischer 1990; with quantisers
 * that follow from the levels' parity: Schwarz et al. 2019).
 *
 * A level k stands for k steps in the first quantiser and for k - 1/2 in the second, and 0 for 0 in both. A machine of eight
 * states, in state 0 before a harmonic's first level, moves by the parity of each level that is not 0, in the order in which
 * levels are coded. States 0..3 mean the first quantiser for the next level, 4..7 the second. Along any way through the states
 * the values to choose from lie half a step apart, at the cost in bits of a whole step: FORMAT.md, "From levels to values".
 */
#ifndef MODEL_SPECTRAL_DEPENDENT_H
#define MODEL_SPECTRAL_DEPENDENT_H

#include <stdint.h>

enum { DEPENDENT_STATES = 8 };

static inline uint32_t dependent_quantiser(uint32_t state) { return state >> 2; }

/* The state behind a level of this size, 1 or more. */
static inline uint32_t dependent_next(uint32_t state, uint32_t size)
{
	static const uint8_t NEXT[DEPENDENT_STATES][2] = {{0, 1}, {4, 5}, {1, 0}, {5, 4}, {6, 7}, {3, 2}, {2, 3}, {7, 6}};
	return NEXT[state][size & 1];
}

#endif
