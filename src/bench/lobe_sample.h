/*
 * lobe_sample.h: the cells that an analytic fit looks at, with their geometry and cosine weights.
 */
#ifndef BENCH_LOBE_SAMPLE_H
#define BENCH_LOBE_SAMPLE_H

#include "angles.h"

struct lobe_sample {
	size_t count;
	struct cell_angles *angles;
	uint32_t *cell; /* index in the lattice */
	double *weight; /* w cos^2; the sum is 1 */
	double *rgb[3]; /* in units of `unit` */
	double unit;    /* largest sampled value, 1/sr; 1 if all are 0 */
};

/* Every theta_h, every stride_d-th theta_d and every stride_p-th phi_d, valid, both angles at most 80 degrees. */
bp_status lobe_sample_take(const struct lattice *lattice, uint32_t stride_d, uint32_t stride_p, struct lobe_sample *out,
                           bp_error *error);
void lobe_sample_free(struct lobe_sample *sample);

#endif
