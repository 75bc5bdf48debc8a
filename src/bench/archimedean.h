/*
 * archimedean.h: A. Ozturk, M. Kurt, A. Bilgili, "A copula-based BRDF model", Computer Graphics Forum 29(6), 2010:
 * a channel is a density over (theta_h, theta_d, phi_d) with its own three marginals and an Archimedean copula:
 *
 *     f = diffuse + K f_h f_d f_phi c(u, v, w; alpha)         u, v, w = F_h, F_d, F_phi (or 1 - F, see below)
 *
 * Densities of three variables, from c = psi'''(t) (psi^-1)'(u) (psi^-1)'(v) (psi^-1)'(w), t = sum of psi^-1:
 *
 *     Frank     s = p q_u q_v q_w,  p = 1 - e^-alpha, q_u = (1 - e^-alpha u) / p
 *               c = alpha^2 s (1 + s) / (1 - s)^3 e^-alpha(u + v + w) / ((1 - e^-alpha u)(1 - e^-alpha v)(1 - e^-alpha w))
 *     Clayton   c = (1 + alpha)(1 + 2 alpha) (u v w)^-(alpha + 1) (u^-alpha + v^-alpha + w^-alpha - 2)^-(1 / alpha + 3)
 *
 * alpha > 0; alpha -> 0 is independence. In three variables these families know positive dependence only, so any of
 * the axes may be turned round (u = 1 - F), which also covers the negative one. Family, turns and alpha minimise the
 * cosine-weighted error of lobe.h, with the two linear parameters at their least-squares values >= 0 (diffuse and
 * specular, as the authors have it in 2012; without the diffuse one the model does worse).
 *
 * Marginals are the means over the other two axes of the table with its invalid cells filled (log_tensor.h).
 * Per channel H + D + P + 3 float32 and one byte for family and turns; MERL: 1089 numbers and 3 bytes, 4359 bytes.
 */
#ifndef BENCH_ARCHIMEDEAN_H
#define BENCH_ARCHIMEDEAN_H

#include "../merl/lattice.h"

enum archimedean_family { ARCHIMEDEAN_FRANK, ARCHIMEDEAN_CLAYTON, ARCHIMEDEAN_FAMILIES };

struct archimedean_channel {
	enum archimedean_family family;
	unsigned turned; /* bit a: axis a is turned round */
	float alpha, diffuse, scale;
	float *marginal[3]; /* mean 1 (all 0 for a black channel), per axis: H, D, P values */
	double *cumulative[3]; /* F at the middle of each cell, derived from the marginal */
};

struct archimedean_state {
	struct lattice_dims dims;
	struct archimedean_channel channel[3];
	float *marginals;
	double *cumulatives;
};

/* The copula's density; u, v, w in (0, 1), alpha > 0. */
double archimedean_density(enum archimedean_family family, double alpha, double u, double v, double w);

/* An empty state whose arrays are allocated, and what follows from its marginals. */
bp_status archimedean_alloc(struct lattice_dims dims, struct archimedean_state **out, bp_error *error);
void archimedean_accumulate(struct archimedean_state *state);
void archimedean_free(void *state); /* NULL is allowed */

#endif
