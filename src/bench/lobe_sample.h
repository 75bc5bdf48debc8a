/*
 * lobe_sample.h: the cells that an analytic fit looks at, with their geometry and cosine weights.
 */
#ifndef BENCH_LOBE_SAMPLE_H
#define BENCH_LOBE_SAMPLE_H

#include "angles.h"

struct lobe_sample {
	size_t count;
	struct cell_angles *angles;
	uint32_t *cell;   /* index in the lattice */
	double *weight;   /* w cos^2; the sum is 1 */
	double *relative; /* of each channel, [3][count]: weight / (b + 0.001/sr)^2, or NULL: every channel has `weight` */
	double *rgb[3];   /* in units of `unit` */
	double unit;      /* largest sampled value, 1/sr; 1 if all are 0 */
};

/* Every theta_h, every stride_d-th theta_d and every stride_p-th phi_d, valid, both angles at most 80 degrees. */
bp_status lobe_sample_take(const struct lattice *lattice, uint32_t stride_d, uint32_t stride_p, struct lobe_sample *out,
                           bp_error *error);
/* Adds `relative`: squared errors weighted by it are those of the logarithm, to first order. */
bp_status lobe_sample_make_relative(struct lobe_sample *sample, bp_error *error);

/*
 * min |y - a p - b l|^2 over a, b >= 0, from the inner products of the functions p, l and of both with y (pp > 0).
 * Returns by how much the square falls below |y|^2: 2 (a py + b ly) - a^2 pp - 2 a b pl - b^2 ll >= 0.
 */
double nonnegative_pair(double pp, double pl, double ll, double py, double ly, double *a, double *b);

void lobe_sample_free(struct lobe_sample *sample);

#endif
