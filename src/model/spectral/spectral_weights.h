/*
 * spectral_weights.h: how finely each part of a spectrum is coded. A coefficient is divided by the factors of its place and
 * frequency before it is quantised, and multiplied by them when it is decoded: the step is coarser where errors are worth less.
 * At a given rate the sum of the worth of all errors is least where steps go as worth^(-1/2).
 *
 * By place: an error of the logarithm is worth what it does to a picture: nothing below the horizon, little where light only
 * grazes, in a highlight far above white or where cells are few directions, much where a material is as bright as its pictures
 * are exposed for. A coefficient lies somewhere in the (theta_h, theta_d) plane; its factor is a power of 2, interpolated between
 * weights at the centres of a grid of regions, [theta_h][theta_d], 0 where the table is coded finest. Worth is a statistic of
 * what is measured, and does not change where the table is made s times as bright.
 *
 * By frequency (`graded`): a look-up interpolates between cells, and what is left of an error of frequency w (pi: from cell to
 * cell) is, in the mean over places, (2 + cos w)/3 of its square along each axis. Along phi_d harmonic m has w = pi m/P; along
 * the others the details of step l of the wavelet have w from pi/2^(l+1) to pi/2^l.
 */
#ifndef MODEL_SPECTRAL_SPECTRAL_WEIGHTS_H
#define MODEL_SPECTRAL_SPECTRAL_WEIGHTS_H

#include "merl/lattice.h"
#include "spectrum_inverse.h"

enum {
	SPECTRAL_WEIGHTS_EDGE = 18,
	SPECTRAL_WEIGHTS = SPECTRAL_WEIGHTS_EDGE * SPECTRAL_WEIGHTS_EDGE,
	SPECTRAL_WEIGHTS_EDGE_PLAIN = 10, /* of models that are not graded */
	SPECTRAL_WEIGHT_MOST = 63,        /* of graded ones */
};

struct spectral_weights {
	bool graded; /* edge 18, weights in half octaves; else edge 10, in sixteenths */
	uint8_t weight[SPECTRAL_WEIGHTS];
};

static inline uint32_t spectral_weights_edge(const struct spectral_weights *weights)
{
	return weights->graded ? SPECTRAL_WEIGHTS_EDGE : SPECTRAL_WEIGHTS_EDGE_PLAIN;
}

/*
 * spectral_weights_find.c: from the measured values, in units of `unit` (1/sr). A lattice of fewer than 20 cells along theta_h or
 * theta_d is not graded, and all its weights are 0.
 */
void spectral_weights_find(const struct lattice *lattice, double unit, struct spectral_weights *out);

/*
 * For a table with noise, where even steps would be coarser than it by so many octaves: none of the weights up to 1/2, as finer
 * steps would code more of the noise, all from 3 1/2 on, as if there were none, and their share between.
 */
void spectral_weights_ease(struct spectral_weights *weights, float octaves);

/* The factors of a spectrum (spectrum.h). */
struct spectral_factors {
	float *row;      /* [theta_h theta_d]; owns the block: freed with free() */
	float *harmonic; /* [phi_d] */
};
bp_status spectral_factors_create(struct lattice_dims dims, const struct spectral_weights *weights, struct spectral_factors *out,
                                  bp_error *error);

/* An inverse transform with the factors in its gains. */
bp_status spectral_inverse_create(struct lattice_dims dims, const struct spectral_weights *weights, struct spectrum_inverse **out,
                                  bp_error *error);

/* Divides the spectrum by the factors. */
void spectral_factors_divide(struct lattice_dims dims, const struct spectral_factors *factors, float *spectrum);

#endif
