/*
 * density.h: what the pictures of the model show: conditional pair copulas and errors per theta_h.
 */
#ifndef RENDER_DENSITY_H
#define RENDER_DENSITY_H

#include "model/model.h"

/* Planes of 1/sr over a lattice, and which cells count. */
struct density_source {
	struct lattice_dims dims;
	float *mean;          /* mean of the three channels, per cell; 0 where invalid */
	const uint8_t *valid; /* the caller's, for as long as the source lives */
};

/* The achromatic table of a measured or decoded material. The caller frees *out, also after a failure. */
bp_status density_source_measured(const struct lattice *lattice, struct density_source *out, bp_error *error);
bp_status density_source_decoded(const struct expansion *table, const uint8_t *valid, struct density_source *out,
                                 bp_error *error);
void density_source_free(struct density_source *source); /* a zeroed struct is allowed */

/*
 * The conditional pair-copula density of theta_d and phi_d in theta_h cell i, on the lattice (Bilgili, Ozturk and
 * Kurt 2012):
 *
 *     c(d, phi | h) = f(d, phi | h) / (f(d | h) f(phi | h))
 *
 * density[theta_d][phi_d]; 1 everywhere: independent given theta_h. Cells that are invalid become NaN. They leave
 * gaps, under which plain marginals would be those of the gaps: r_d s_phi is therefore fitted to the valid cells
 * so that their row and column sums are met (quasi-independence, Goodman 1968; by iterative proportional fitting, at most
 * 500 rounds), and c = f / (r s). Without gaps that is the ratio above. Where r s is 0, c is 1. Returns the
 * root mean square of log2 c over cells where f > 0, weighted by r s: how far from independent the slice is.
 */
double density_slice(const struct density_source *source, uint32_t i, float *density);

/*
 * Absolute error per theta_h cell: the mean of |e - b| over valid cells and three channels of slice i, in 1/sr,
 * NaN where no cell is valid; error_mean[dims.theta_h].
 */
void error_profile(const struct lattice *truth, const struct expansion *table, double *error_mean);

/*
 * The same for the paper's model before its pair copulas are compressed. On the lattice eq. 7 is then an identity,
 * and what is left is the colour regression: e_c = max(0, diffuse_c + specular_c * mean of the channels).
 */
void error_profile_uncoded(const struct lattice *truth, const struct colour_fit colour[3], double *error_mean);

#endif
