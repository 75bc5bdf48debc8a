/*
 * marginal.h: the marginals of one channel: geometric means, as the three-way fit
 *
 *     log2 max(x_ijk, 0.0003) ~ h_i + d_j + phi_k
 *
 * over the valid cells, weighted by how far they are seen; cells from the shared slices on by a tenth of that, since the pairs
 * serve them alone. Then the pair copula (theta_h, theta_d) is what is left of the means over phi_d. d and phi stay within a
 * factor of 20 of their mean, so that where little was measured nothing becomes extreme.
 */
#ifndef MODEL_PAPER_MARGINAL_H
#define MODEL_PAPER_MARGINAL_H

#include "importance.h"

struct marginals {
	float *h, *d, *phi; /* > 0; h is 0 where a whole slice is. One block, with what follows: h is freed with free() */
	float *rest;        /* theta_h x theta_d: 2^(the mean over phi_d less h and d), within a factor of 20 of 1 */
	float *measured;    /* theta_h x theta_d: the sum of the weights */
};

bp_status marginals_alloc(struct lattice_dims dims, struct marginals *out, bp_error *error);
/* value[cells] of importance_weigh; shown[cells]: 0 where invalid. */
bp_status marginals_fit(struct lattice_dims dims, const float *value, const float *shown, struct marginals *out, bp_error *error);

#endif
