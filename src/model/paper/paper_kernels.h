/* paper_kernels.h: the loops of the paper's model, compiled twice (math/kernels.h). Arrays are the same or do not overlap. */
#ifndef MODEL_PAPER_PAPER_KERNELS_H
#define MODEL_PAPER_PAPER_KERNELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "model/math/kernels.h"

struct wavelet_filter {
	unsigned taps; /* 2 or 4 */
	float low[4], high[4];
};

/* Where a row of cells lies: cosines of the two directions are even -/+ odd cos(phi_d). */
struct importance_place {
	float even, odd; /* cos theta_d cos theta_h, sin theta_d sin theta_h */
	float area;      /* sin theta_h d(theta_h) sin theta_d cos theta_d: pairs of directions in a cell */
	float relative;  /* of the relative error, which counts everywhere a little */
};

struct paper_kernels {
	/* wavelet.c */
	void (*wavelet_split)(const struct wavelet_filter *f, const float *in, size_t n, size_t width, float *low, float *high);
	void (*wavelet_join)(const struct wavelet_filter *f, const float *low, const float *high, size_t n, size_t width, float *out);
	void (*mirror_split)(const float *row, size_t n, float *even, float *odd);
	void (*mirror_join)(const float *even, const float *odd, size_t n, float *row);

	/* sparse_fit.c: value = weight (wanted - value); out = weight in, returns the sum of weight in^2 */
	void (*residual)(const float *weight, const float *wanted, size_t n, float *value);
	double (*weigh)(const float *weight, const float *in, size_t n, float *out);
	/* out += factor x; out = x + factor out */
	void (*add_scaled)(float factor, const float *x, size_t n, float *out);
	void (*turn)(float factor, const float *x, size_t n, float *out);
	/* gain = energy (x + 0.7 gradient/(energy + least))^2 */
	void (*gains)(const float *x, const float *gradient, const float *energy, float least, size_t n, float *gain);

	/* pairs.c, p = u v: the sums of weight value p and of weight p^2, over the row or added to those of every column */
	void (*fit_row)(const float *weight, const float *value, const float *u, const float *v, size_t n, double out[2]);
	void (*fit_columns)(const float *weight, const float *value, float u, const float *v, size_t n, float *numerator,
	                    float *denominator);
	/* slices.c: value/(row column) and weight (row column)^2; 0 where the product is */
	void (*quotients)(const float *weight, const float *value, float row, const float *column, size_t n, float *quotient,
	                  float *energy);

	/* importance.c; normalise_row: value factor[0] factor[1] where valid, at most 1e15, below 1e-30: 0 */
	void (*importance_row)(const struct importance_place *place, const float *cos_phi, const float *value, const uint8_t *valid,
	                       size_t n, float *weight);
	void (*normalise_row)(const double *value, const uint8_t *valid, const double factor[2], size_t n, float *out);

	/* paper_expand.c: out = row column dphi (NULL: 1); out = max(0, diffuse + specular out), at most limit */
	void (*paper_row)(float row, const float *column, const float *dphi, size_t n, float *out);
	void (*paper_colour)(float diffuse, float specular, float limit, size_t n, float *out);
};

KERNELS_OF(paper)

#endif
