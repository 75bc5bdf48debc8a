/*
 * archimedean.h: A. Ozturk, M. Kurt, A. Bilgili, "A copula-based BRDF model", Computer Graphics Forum 29(6), 2010:
 * a channel is a density over (theta_h, theta_d, phi_d) with its own three marginals and an Archimedean copula:
 *
 *     f = diffuse + K f_h f_d f_phi c(u, v, w; alpha)         u, v, w = F_h, F_d, F_phi (or 1 - F, see below)
 *
 * A marginal is constant over a cell, so the mean of f over a cell is, exactly,
 *
 *     f_ijk = diffuse + K cells M_ijk                         M_ijk the copula's mass between the cell's F
 *
 * (archimedean_copula.h), which stays finite in the corner where Clayton's density does not, and whose means over two axes
 * are the third's marginal, exactly. In three variables these families know positive dependence only, so any of the
 * axes may be turned round (u = 1 - F), which also covers the negative one.
 *
 * Marginals are the means over the other two axes of the table with its invalid cells filled (log_tensor.h), less an offset
 * >= 0, the diffuse part's share of them. Family, turns, alpha and the offset minimise the cosine-weighted error of
 * lobe.h, with the two linear parameters at their least-squares values >= 0 (diffuse and specular, as the authors
 * have it in 2012; without the diffuse one the model does worse).
 *
 * Per channel H + D + P + 3 float32 and one byte for family and turns; MERL: 1089 numbers and 3 bytes, 4359 bytes.
 */
#ifndef BENCH_ARCHIMEDEAN_H
#define BENCH_ARCHIMEDEAN_H

#include "archimedean_copula.h"
#include "baseline.h"

struct archimedean_channel {
	enum archimedean_family family;
	unsigned turned; /* bit a: axis a is turned round */
	float alpha, diffuse, scale;
	float marginal[3][LATTICE_EXTENT_MAX];  /* mean 1 (all 0 for a black channel), per axis: H, D, P values */
	double edge[3][LATTICE_EXTENT_MAX + 1]; /* F where each cell begins, and 1; derived from the marginal */
};

struct archimedean_state {
	struct lattice_dims dims;
	struct archimedean_channel channel[3];
};

static inline uint32_t archimedean_extent(struct lattice_dims dims, int axis)
{
	return axis == 0 ? dims.theta_h : axis == 1 ? dims.theta_d : dims.phi_d;
}

/* Fills the edges from the marginals. */
void archimedean_accumulate(struct lattice_dims dims, struct archimedean_channel *channel);

/*
 * The edges of the cells along each axis, turned where the axis is: H + 1, D + 1, P + 1, out[axis] pointing into `room` of
 * ARCHIMEDEAN_EDGES_MAX. Returns the sign that a cell's mass between them has: -1 where an odd number of axes is turned.
 */
enum { ARCHIMEDEAN_EDGES_MAX = 3 * (LATTICE_EXTENT_MAX + 1) };
double archimedean_edges(struct lattice_dims dims, const struct archimedean_channel *channel, double alpha,
                         struct copula_edge *room, const struct copula_edge *out[3]);

/* The baseline's fit (archimedean_fit.c). */
bp_status archimedean_fit(const struct baseline *self, const struct bench_material *material, struct fitted *out,
                          bp_error *error);

#endif
