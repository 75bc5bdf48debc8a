/*
 * marginal.h: a measured lattice as a density, and its empirical marginals.
 *
 * The density is the achromatic table, the mean of the three channels, divided by its mean K over the valid cells
 * (step 0 of the paper: K stands for the sum times the cell size). Invalid cells take part in nothing: every
 * marginal is a mean over the valid cells that share its index, not a sum, so that a row of few valid cells is
 * not mistaken for a dark one. Means of an index without any valid cell are undefined (valid = 0).
 *
 *     h_i = mean of v over (j, k)     hd_ij = mean of v over k     hphi_ik = mean of v over j     d_j, phi_k alike
 */
#ifndef MODEL_PAPER_MARGINAL_H
#define MODEL_PAPER_MARGINAL_H

#include "merl/lattice.h"

/* Densities and means below this are 0: the smallest normal number of single precision, in which tables are decoded. */
#define DENSITY_DARK 0x1p-126

/* Means over one index or one pair of indices. */
struct means {
	double *value;  /* >= 0; 0 where !valid */
	uint8_t *valid; /* 1: at least one valid cell */
	uint32_t *count; /* valid cells */
};

struct density {
	struct lattice_dims dims;
	const uint8_t *valid;         /* the lattice's */
	double mean;                  /* K, 1/sr; 0 when all is dark, and then every value is 0 */
	double *value;                /* v of every cell; 0 where invalid */
	struct means axis[3];         /* h, d, phi */
	struct means hd, hphi;        /* theta_h x theta_d, theta_h x phi_d, row-major */
};

/*
 * Builds the density and all its means from a lattice with at least one valid cell, which must outlive it.
 * Relative errors of the means are below 1e-14 (block sums), those below DENSITY_DARK apart. Values from 1e-300 to 1e300 are in range.
 */
bp_status density_build(const struct lattice *lattice, struct density *out, bp_error *error);
void density_free(struct density *density);

#endif
