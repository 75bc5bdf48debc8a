/*
 * sampler.h: the inside of struct sampler (sample.h), shared by what builds it and what draws from it.
 */
#ifndef MODEL_SAMPLE_SAMPLER_H
#define MODEL_SAMPLE_SAMPLER_H

#include "model/table/table.h"
#include "horizon_s.h"
#include "sample.h"

enum { NODES = 40, PHIS_ROOT = 4, PHIS = PHIS_ROOT * PHIS_ROOT, BINS_ROOT = 8, BINS = BINS_ROOT * BINS_ROOT };
/* Intervals of s, from every 32nd of an octave between 2^-25, the end of the first bin, and 1/2; and one for what is below. */
enum { GUESSES = 24 * 32 + 2 };

#define PI_F 3.14159265f
#define COSINE_SHARE 0.06f

struct sampler {
	float s_edge[BINS + 1], s_per[BINS]; /* edges of the bins, and 1 / their widths */
	float s_next[BINS];                  /* the upper edge; the last one is infinite */
	uint8_t guess[GUESSES];              /* the bin that an interval begins in: at most one ends within it */
	float phi_mass[NODES][PHIS + 1];     /* cumulative mass at the edges of the bins of |phi_h|: 0, ..., 1 */
	float s_mass[NODES][PHIS][BINS + 1]; /* conditional on phi, cumulative at the edges of s, not cut at the horizon: 0, ..., 1 */
};

/* quarter_turns_of_squares; of the vector form, because compilers make a branch of the scalar one that no predictor can guess */
static inline float turns_of_squares(float y, float x)
{
	return quarter_turns_of_squares_x4((f32x4){y, 0, 0, 0}, (f32x4){x, 1, 1, 1}, (f32x4){1, 1, 1, 1})[0];
}

/* An angle's place between the nodes, from the squares of its sine and cosine: dense at grazing. cosine = 0: the last node. */
static inline float node_coordinate(float sine2, float cosine2)
{
	return (NODES - 1) * (1 - sqrtf(turns_of_squares(cosine2, sine2)));
}

static inline double node_theta(int node)
{
	double rest = 1 - (double)node / (NODES - 1);
	/* exactly at grazing nothing is visible: the last node stands a little above */
	return (1 - fmax(rest * rest, 1e-4)) * 1.5707963267948966;
}

static inline int guess_of(float s)
{
	int at = (int)(bits_of_float(s) >> 18) - (int)(0x33000000 >> 18) + 1; /* 0x33000000: 2^-25 */
	at = at > 0 ? at : 0;
	return at < GUESSES - 1 ? at : GUESSES - 1;
}

/* The bin of s >= 0; beyond the last edge the last. */
static inline int s_bin(const struct sampler *p, float s)
{
	int n = p->guess[guess_of(s)];
	return n + (s >= p->s_next[n]);
}

#endif
