/*
 * lobe.h: analytic models of the form
 *
 *     f_c = diffuse_c / pi + specular_c lobe(shape; wi, wo)          c = R, G, B
 *
 * with one lobe shape for the three channels (a material has one roughness) and a diffuse and a
 * specular albedo per channel: 6 + shape_count float32 parameters.
 *
 * Objective (Ngan, Durand, Matusik 2005, section 3): the cosine-weighted squared error
 *
 *     E^2 = sum w (f cos - b cos)^2 / sum w
 *
 * over the valid cells with theta_i, theta_o <= 80 degrees, summed over the channels. w is the
 * measure d omega_i d omega_o = 4 cos theta_d d omega_h d omega_d of the cell; because a cell stands for
 * both orders of the two directions, cos^2 is the mean of cos^2 theta_i and cos^2 theta_o.
 *
 * For a given shape the best albedos are a linear least-squares problem with two unknowns >= 0
 * (variable projection), so the search runs over the shape alone: a grid of starts and Nelder-Mead (GSL
 * nmsimplex2) from the best three on a thin sample of cells, then from the best of these on a denser one. A sample
 * takes every theta_h and a regular stride of theta_d and phi_d: nothing is random.
 */
#ifndef BENCH_LOBE_H
#define BENCH_LOBE_H

#include <stdlib.h>

#include "angles.h"
#include "baseline.h"

enum { LOBE_SHAPE_MAX = 3 };

/* The models divide by cosines; from here down to the horizon, and a little below, where lattices hold values, by this one. */
#define LOBE_COSINE_MIN 0.01

/* One search variable: shape = exp(free) or 1 / (1 + exp(-free)). */
struct lobe_axis {
	enum { LOBE_EXP, LOBE_UNIT } map;
	double first, last; /* shape values of the grid's ends */
	int steps;          /* grid points, evenly spaced in the free variable */
};

struct lobe_model {
	int shape_count;
	struct lobe_axis axis[LOBE_SHAPE_MAX];
	double (*value)(const double *shape, struct cell_angles angles); /* 1/sr; cosines >= LOBE_COSINE_MIN */
};

struct lobe_state {
	const struct lobe_model *model;
	float shape[LOBE_SHAPE_MAX], diffuse[3], specular[3];
};

/*
 * LOBE_COSINE is the objective above. A mirror's peak dominates it: of chrome-steel it leaves 6.8 dB where a black picture has
 * 4.9. LOBE_RELATIVE divides each squared error by (b + 0.001/sr)^2, which is the error of the logarithm to first order. The
 * benchmark has both, and names the better one of each material.
 */
enum lobe_objective { LOBE_COSINE, LOBE_RELATIVE };

/* What baselines of this kind are variants of; their functions. */
struct lobe_variant {
	const struct lobe_model *model;
	enum lobe_objective objective;
};
bp_status lobe_fit(const struct baseline *self, const struct bench_material *material, struct fitted *out, bp_error *error);
bp_status lobe_expand(const void *state, struct expansion *out, bp_error *error);
evaluate_fn lobe_evaluate;

#define LOBE_BASELINE(text, lobe_model, lobe_objective) \
	{ \
		.reference = text, .variant = &(const struct lobe_variant){&lobe_model, lobe_objective}, .fit = lobe_fit, \
		.expand = lobe_expand, .evaluate = lobe_evaluate, .free_state = free \
	}

/* The models' lobes, for the tests. */
extern const struct lobe_model LOBE_WARD, LOBE_COOK_TORRANCE, LOBE_EDWARDS;

#endif
