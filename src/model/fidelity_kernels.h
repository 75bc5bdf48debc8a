/* fidelity_kernels.h: the sums of fidelity.h, compiled twice (math/kernels.h). */
#ifndef MODEL_FIDELITY_KERNELS_H
#define MODEL_FIDELITY_KERNELS_H

#include <stddef.h>
#include <stdint.h>

#include "model/math/kernels.h"

struct fidelity_sums {
	double log_squares;        /* of log2 ratios */
	double hidden_log_squares; /* of them, those of hidden cells */
	double cube_root_squares;
	double largest_relative;
};

/* One channel of a decoded table, and where its sums go. */
struct fidelity_table {
	const float *e;
	double unit;
	struct fidelity_sums *sums;
};

struct fidelity_kernels {
	/*
	 * Adds the n cells of one channel of one theta_h slice to the sums of every table: b measured, unit * e decoded, in 1/sr;
	 * cosine >= 0; cells with valid = 0 add nothing. hidden <= valid.
	 */
	void (*fidelity_slice)(const double *b, const uint8_t *valid, const uint8_t *hidden, const float *cosine, size_t n,
	                       const struct fidelity_table *tables, size_t count);
};

KERNELS_OF_THREE(fidelity)

#endif
