/*
 * default_sample.h: cells that stand for all, spread evenly over all angles. Which ones depends on validity alone.
 */
#ifndef MODEL_DEFAULT_SAMPLE_H
#define MODEL_DEFAULT_SAMPLE_H

#include "model.h"

struct default_sample {
	double *x;    /* the achromatic value; owns the block */
	double *y[3]; /* the channels, one behind the other, n each */
	size_t n;     /* 65,536 at least, where there are as many */
};

bp_status default_sample_draw(const struct lattice *lattice, struct default_sample *out, bp_error *error);
void default_sample_free(struct default_sample *sample); /* an empty one is allowed */

/* The paper's regression of each channel on the achromatic value. */
bp_status default_sample_colour(const struct default_sample *sample, struct colour_fit colour[3], bp_error *error);

/* The channels by the sums of their values: from here on it does not matter which is called red. */
void default_sample_order(const struct default_sample *sample, int order[3]);

/* The unit of default_model.h. Rearranges the sample: the last to be asked. */
double default_sample_unit(struct default_sample *sample, const struct lattice *lattice);

#endif
