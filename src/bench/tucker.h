/*
 * tucker.h: A. Bilgili, A. Ozturk, M. Kurt, "A general BRDF representation based on tensor decomposition",
 * Computer Graphics Forum 30(8), 2011: Tucker decomposition of the log-mapped tensor in half/difference
 * coordinates, repeated on what the previous ones left:
 *
 *     log(f + 1e-3) = sum_t u_t(theta_h) v_t(theta_d) w_t(phi_d) z_t(colour)
 *
 * Each repetition is a Tucker decomposition with a 1 x 1 x 1 x 1 core (which z_t absorbs), found by alternating
 * least squares. A term is 90 + 90 + 180 + 3 float32 on MERL's lattice: 1452 bytes, 41 terms in 60,400 bytes.
 * The number of terms follows from the budget; at least one is kept.
 *
 * For speed the terms are sought in the tensor's projection onto the leading 40 singular vectors of each
 * unfolding (truncated HOSVD, eigenvectors by LAPACK), where a sweep costs 1/20; what is cut off there is
 * far below what a hundred terms leave.
 */
#ifndef BENCH_TUCKER_H
#define BENCH_TUCKER_H

#include "log_tensor.h"

struct tucker_state {
	struct lattice_dims dims;
	uint32_t terms;
	uint32_t stride;      /* between neighbours along an axis; >= terms */
	float *u, *v, *w, *z; /* u[n * stride + t], ..., z[colour * stride + t]; one allocation at u */
};

/* Decomposes with exactly `terms` terms (fewer when nothing is left). */
bp_status tucker_decompose(const struct log_tensor *tensor, uint32_t terms, struct tucker_state **out, bp_error *error);
void tucker_free(void *state);

#endif
