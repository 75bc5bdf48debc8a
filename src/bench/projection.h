/*
 * projection.h: a table's logarithm in the leading singular vectors of its three unfoldings (truncated HOSVD:
 * De Lathauwer, De Moor, Vandewalle 2000). The colour axis stays as it is.
 */
#ifndef BENCH_PROJECTION_H
#define BENCH_PROJECTION_H

#include "log_tensor.h"

enum { RANK_MAX = 40 };

/* core[colour][h][d][p], and each axis's orthonormal basis, row-major extent x rank; one allocation at core. */
struct projection {
	size_t h, d, p; /* ranks: the extents, RANK_MAX at most */
	double *core, *basis_h, *basis_d, *basis_p;
};

bp_status projection_make(const struct log_tensor *tensor, struct projection *out, bp_error *error);
void projection_free(struct projection *projection); /* a zeroed struct is allowed */

/* Back from a basis to its axis: out[n * stride] = sum over r of basis[n][r] x[r], for n < extent. */
void projection_lift(const double *basis, size_t extent, size_t rank, const double *x, float *out, size_t stride);

#endif
