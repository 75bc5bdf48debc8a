/* spectral_weights_find.c: what errors are worth, from what was measured: the fit's part of spectral_weights.h. */
#include "spectral_weights.h"

#include <math.h>
#include <string.h>

#include "memory.h"
#include "model/math/fast_math.h"
#include "spectral_kernels.h"

enum { EDGE = SPECTRAL_WEIGHTS_EDGE, LEAST_CELLS = 20, PER_OCTAVE = 8, BINS = 128 * PER_OCTAVE };
_Static_assert(LEAST_CELLS >= EDGE, "every region has cells");

/* Figures that were found by trial: VARIANTS.md, "What errors are worth". */
static const double PICTURE = 0.95;  /* share of the picture in an error's worth; the rest is the error of the logarithm itself */
static const double STEEPNESS = 1.3; /* 1: least by this worth, which is smoother than a picture's; less: safer for other uses */
static const double LEAST = 0.02;    /* of the mean worth, even where nothing is seen */
static const double EXPOSURE = 7;    /* white, where the 90 % point of value times cosine is 1: that of a sphere, within a half */
static const double AMBIENT = 0.3;   /* of white: what else a pixel holds */
static const struct spectral_light LIGHTS[] = {
	{0.03, 150}, {0.15, 24}, {1, 3}, {3, 1}}; /* those of a sky, weak and strong lamps, where white is 1 */
enum { LIGHT_COUNT = sizeof LIGHTS / sizeof *LIGHTS };

/* What is gathered of a region. */
struct region {
	double picture; /* sum of worths */
	double seen, cells;
};

struct survey {
	const struct lattice *lattice;
	const struct lattice_cosines *centres;
	double factor;          /* of values */
	double *bins;           /* first pass: shares of directions by log2 of value times cosine, BINS from 2^-64 on */
	struct region *regions; /* second pass: values are in units of white */
};

enum { ROW_SPARSE = 90, EVERY = 15, SAMPLES_MAX = 2 * ROW_SPARSE }; /* two directions of each cell */
_Static_assert(LATTICE_EXTENT_MAX / EVERY < ROW_SPARSE, "a row's samples have room");

/* Every 15th cell of a row, another phi_d in each; all of a short one. */
static void row_survey(const struct survey *s, uint32_t i, uint32_t j)
{
	const struct spectral_kernels *kernels = spectral_kernels_get();
	const struct lattice *lattice = s->lattice;
	const struct lattice_dims d = lattice->dims;
	const struct lattice_cosines *c = s->centres;
	const uint32_t every = d.phi_d < ROW_SPARSE ? 1 : EVERY;
	const size_t row = lattice_index(d, i, j, 0);
	/* Pairs of directions in a cell, but for a factor: sin theta_h d theta_h cos theta_d sin theta_d d theta_d d phi_d. */
	const double directions = (i + 0.5) / d.theta_h * c->sin_h[i] * 2 * c->sin_d[j] * c->cos_d[j];
	struct region *region = s->regions ? &s->regions[i * EDGE / d.theta_h * EDGE + j * EDGE / d.theta_d] : NULL;
	double radiance[SAMPLES_MAX], other[SAMPLES_MAX],
		worth[SAMPLES_MAX]; /* two of each cell: value times one cosine, and the other */
	size_t n = 0;

	for (uint32_t k = (3 * i + 5 * j) % every; k < d.phi_d; k += every) {
		const double a = c->cos_d[j] * c->cos_h[i], b = c->sin_d[j] * c->sin_h[i] * fabs(c->cos_p[k]);
		for (int q = 0; q < 3; q++) /* a cell of the row after next: no processor foresees where a row's samples begin */
			memory_ask(lattice->rgb[q] + row + k, (2 * d.phi_d + 10) * sizeof(double));
		if (region)
			region->cells++;
		if (!lattice->valid[row + k] || a - b <= 0)
			continue;
		const double value =
			(lattice->rgb[0][row + k] * s->factor + lattice->rgb[1][row + k] * s->factor + lattice->rgb[2][row + k] * s->factor) /
			3;
		radiance[n] = value * (a - b);
		other[n++] = a + b;
		radiance[n] = value * (a + b);
		other[n++] = a - b;
		if (region)
			region->seen++;
	}
	if (region) {
		kernels->spectral_worths(radiance, n, LIGHTS, LIGHT_COUNT, AMBIENT, worth);
		for (size_t m = 0; m < n; m++)
			region->picture += directions * (worth[m] * other[m]);
		return;
	}
	for (size_t m = 0; m < n; m++)
		radiance[m] = fmin(fmax(radiance[m], 0x1p-63), 0x1p63);
	kernels->spectral_log2s(radiance, n);
	for (size_t m = 0; m < n; m++)
		s->bins[(int)((radiance[m] + 64) * PER_OCTAVE)] += directions * other[m];
}

static void table_survey(const struct survey *s)
{
	for (uint32_t i = 0; i < s->lattice->dims.theta_h; i++)
		for (uint32_t j = 0; j < s->lattice->dims.theta_d; j++)
			row_survey(s, i, j);
}

/* White, in units: where a picture of the material is exposed for. */
static double white_of(const double bins[BINS])
{
	double sum = 0, below = 0;
	int n = 0;

	for (int b = 0; b < BINS; b++)
		sum += bins[b];
	while (n + 1 < BINS && below + bins[n] <= 0.9 * sum)
		below += bins[n++];
	return EXPOSURE * fast_exp2((double)n / PER_OCTAVE - 64);
}

void spectral_weights_find(const struct lattice *lattice, double unit, struct spectral_weights *out)
{
	const struct lattice_dims d = lattice->dims;
	double bins[BINS] = {0}, steps[SPECTRAL_WEIGHTS], finest = INFINITY, picture = 0, cells = 0;
	struct region regions[SPECTRAL_WEIGHTS] = {0};
	struct lattice_cosines centres;
	struct survey survey = {.lattice = lattice, .centres = &centres, .factor = 1 / unit, .bins = bins};

	memset(out, 0, sizeof *out);
	if (d.theta_h < LEAST_CELLS || d.theta_d < LEAST_CELLS)
		return;
	out->graded = true;
	lattice_centres(d, &centres);
	table_survey(&survey);
	survey.factor /= white_of(bins);
	survey.regions = regions;
	table_survey(&survey);
	for (int r = 0; r < SPECTRAL_WEIGHTS; r++) {
		picture += regions[r].picture;
		cells += regions[r].cells;
	}
	if (!(picture > 0))
		return;
	for (int r = 0; r < SPECTRAL_WEIGHTS; r++) {
		const double share = PICTURE * regions[r].picture / picture * cells + (1 - PICTURE) * regions[r].seen;
		steps[r] = -0.5 * STEEPNESS * fast_log2(share / regions[r].cells + LEAST);
		finest = fmin(finest, steps[r]);
	}
	for (int r = 0; r < SPECTRAL_WEIGHTS; r++)
		out->weight[r] = (uint8_t)fmin(2 * (steps[r] - finest) + 0.5, SPECTRAL_WEIGHT_MOST);
}
