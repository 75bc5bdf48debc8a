/*
 * stress_cases.h: materials made to break things: extremes, holes, steps, noise, faults of every kind.
 *
 * All are made by code from a number and a seed, on any legal lattice. Planes are in 1/sr, as lattice_read
 * leaves them; invalid cells are made as a file would hold them (negative, NaN, infinite) and sorted out by
 * lattice_validate.
 */
#ifndef TESTS_STRESS_CASES_H
#define TESTS_STRESS_CASES_H

#include "merl/lattice.h"

/* A family of cases; each has variants 0..variant_count-1. */
struct stress_kind {
	const char *name;
	unsigned variant_count;
	void (*make)(struct lattice *lattice, unsigned variant, uint64_t seed);
};

extern const struct stress_kind STRESS_KINDS[];
extern const unsigned STRESS_KIND_COUNT;

/* A case on a new lattice, which the caller frees. A case without a valid cell is legal here: packing must refuse it. */
bp_status stress_case_make(const struct stress_kind *kind, unsigned variant, uint64_t seed, struct lattice_dims dims,
                           struct lattice *out, bp_error *error);

/* Uniform in (0, 1), and normal; *state is any number. */
double stress_uniform(uint64_t *state);
double stress_normal(uint64_t *state);

#endif
