/*
 * rate.h: about how many bytes the bit planes take at a step, before they are coded.
 *
 * A level costs about 3.5 bits for its place and its sign and one for every bit below its highest (measured on surrogates). How
 * well its neighbours predict it differs from material to material by a third; once some planes have been coded that is
 * known, and the rest follows to about 1 %.
 */
#ifndef CODEC_SPECTRAL_RATE_H
#define CODEC_SPECTRAL_RATE_H

#include "model/spectral/spectral.h"

enum { RATE_PER_OCTAVE = 16, RATE_BINS = 256 * RATE_PER_OCTAVE, RATE_PLANES = 3 };

struct rate {
	double above[RATE_BINS + 1]; /* coefficients in this bin of sizes or a higher one */
	float largest;               /* size */
};

/* Looks at every third row, at all for `largest`. */
void rate_measure(const struct spectral_model *model, struct lattice_dims dims, struct rate *out);

/* Bits of all planes from `plane` up, levels being floor(size / step + rounding). */
double rate_bits(const struct rate *rate, double step, double rounding, uint32_t plane);

/* The step at which rate_bits of all planes is `bits`; not below `least`. */
double rate_step(const struct rate *rate, double bits, double rounding, double least);

/*
 * Bits that the coder takes for each of rate_bits where all planes take so many bytes: fitted to 50 clean and to 50 noisy
 * surrogates at 4,096, 16,000 and 60,400 bytes, clean ones 1 % above their median, as few lie far below, noisy ones at 200,000
 * too. Two of three are within 5 %, of noisy ones within 3 %.
 */
double rate_each(double bytes, bool noisy);

/* What all planes will have taken, in the unit of `taken`: what planes 1, 2 and up had taken at their ends. */
double rate_foresee(const struct rate *rate, double step, double rounding, const double taken[RATE_PLANES]);

#endif
