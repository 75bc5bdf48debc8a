/*
 * reciprocity.h: how far values are from those of the exchanged directions.
 */
#ifndef MERL_RECIPROCITY_H
#define MERL_RECIPROCITY_H

#include <stdint.h>

#include "origin.h"

enum { RECIPROCITY_BINS = 2000 };

/* How often |a - b| / ((a + b) / 2), 0 to 2, fell into each step of 1/1000. Start from a zeroed struct. */
struct reciprocity {
	uint64_t bins[RECIPROCITY_BINS + 1];
	uint64_t count;
};

/* One pair of values, not negative. */
void reciprocity_add(struct reciprocity *reciprocity, double a, double b);

/* Sets compared, median and percentile95, each to the middle of its step; 0 where nothing was compared. */
void reciprocity_tell(const struct reciprocity *reciprocity, struct origin *origin);

#endif
