/*
 * spectral_survey.h: cells that stand for all, spread evenly over all angles. Which ones depends on validity alone.
 */
#ifndef MODEL_SPECTRAL_SPECTRAL_SURVEY_H
#define MODEL_SPECTRAL_SPECTRAL_SURVEY_H

#include "model/robust/robust.h"

struct spectral_survey {
	double *x;    /* the achromatic value; owns the block: freed with free() */
	double *y[3]; /* the channels, one behind the other, n each */
	size_t n;     /* 65,536 at least, where there are as many */
};

bp_status spectral_survey_draw(const struct lattice *lattice, struct spectral_survey *out, bp_error *error);

/* The paper's regression of each channel on the achromatic value. */
bp_status spectral_survey_colour(const struct spectral_survey *sample, struct colour_fit colour[3], bp_error *error);

/* The channels by the sums of their values: from here on it does not matter which is called red. */
void spectral_survey_order(const struct spectral_survey *sample, int order[3]);

/* The unit of spectral.h. Rearranges the sample: the last to be asked. */
double spectral_survey_unit(struct spectral_survey *sample, const struct lattice *lattice);

#endif
