/*
 * stress_reference.h: figures worked out slowly, in long double, for comparison with the library's.
 */
#ifndef TESTS_STRESS_REFERENCE_H
#define TESTS_STRESS_REFERENCE_H

#include "model/fidelity.h"

/*
 * The figures of fidelity.h by log10l, cbrtl and long double sums. The cosines are lattice_corner_cosines', rounded to
 * single precision: from exact cosines the cube root figure would differ by up to 2e-8.
 */
void reference_fidelity(const struct lattice *truth, const struct expansion *table, struct fidelity *out);

/* The largest deviation of the green channel's marginals, as logarithms to base 2, from the same fit in long double. Negative: it failed. */
double reference_marginals(const struct lattice *lattice);

/* Deviation of two figures relative to the second, which counts as at least `floor`. */
double relative_deviation(double found, double wanted, double floor);

#endif
