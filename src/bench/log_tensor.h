/*
 * log_tensor.h: the best simple thing a user can do before a general codec or a tensor decomposition:
 * the logarithm of the table, with the invalid cells filled along theta_d.
 */
#ifndef BENCH_LOG_TENSOR_H
#define BENCH_LOG_TENSOR_H

#include "merl/lattice.h"

/* Added before the logarithm, 1/sr: the metrics' own offset. */
#define LOG_OFFSET 1e-3

/* plane[c][cell] = log(value + LOG_OFFSET); an invalid cell copies the nearest valid one below it in theta_d (else above,
 * else a neighbouring phi_d, else a neighbouring theta_h). 3 * cells floats, one allocation at plane[0]. */
struct log_tensor {
	struct lattice_dims dims;
	float *plane[3];
};

bp_status log_tensor_make(const struct lattice *lattice, struct log_tensor *out, bp_error *error);
void log_tensor_free(struct log_tensor *tensor);

/* The way back: max(0, exp(x) - LOG_OFFSET), x clamped to [-50, 50]. */
float log_tensor_value(float x);

/* source[cell]: the valid cell that stands in for `cell` (itself where valid); refuses a table without a valid cell. */
bp_status lattice_fill_sources(const struct lattice *lattice, uint32_t *source, bp_error *error);

#endif
