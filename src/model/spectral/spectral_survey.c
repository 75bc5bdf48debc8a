/* spectral_survey.c: what a sample of the cells tells. */
#include "spectral_survey.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "spectral.h"
#include "model/robust/robust.h"
#include "model/math/select.h"

enum { SAMPLE = 1 << 16 };

static size_t common_divisor(size_t a, size_t b)
{
	while (b) {
		const size_t rest = a % b;
		a = b;
		b = rest;
	}
	return a;
}

bp_status spectral_survey_draw(const struct lattice *lattice, struct spectral_survey *out, bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims), p = lattice->dims.phi_d;
	size_t every = lattice->valid_count / SAMPLE + 1,
		   n = 0; /* one cell of so many; no common factor: another phi_d in every row */
	double *y[3];

	while (common_divisor(every, p) != 1)
		every++;
	const size_t room = cells / every + 1;
	out->x = malloc(room * 4 * sizeof *out->x);
	if (!out->x)
		return error_memory(error, room * 4 * sizeof *out->x);
	for (size_t c = 0; c < 3; c++)
		y[c] = out->x + (c + 1) * room;
	for (size_t i = 0; i < cells; i += every) {
		/* Within the stride, the first valid cell: where few are valid, none is passed over. */
		size_t at = i;
		const size_t last = i + every < cells ? i + every : cells;
		while (at < last && !lattice->valid[at])
			at++;
		if (at == last)
			continue;
		for (int c = 0; c < 3; c++) {
			memory_ask(lattice->rgb[c] + at, 8 * every * sizeof(double)); /* eight samples on */
			y[c][n] = lattice->rgb[c][at];
		}
		out->x[n] = y[0][n] / 3 + y[1][n] / 3 + y[2][n] / 3;
		n++;
	}
	out->n = n;
	for (size_t c = 0; c < 3; c++) {
		out->y[c] = out->x + (c + 1) * n;
		memmove(out->y[c], y[c], n * sizeof *y[c]);
	}
	return BP_OK;
}

/*
 * The paper's regression of each channel on the measured achromatic value. The fields carry colour, so these six numbers are a
 * summary here: a sample gives them in a twentieth of the time. On the nine surrogates of manifests/paper-nine.txt the slopes
 * differ by 0.7 % in the mean from those of all cells, at the worst by 14 % (alum-bronze's blue, where all cells do not converge
 * and the sample does).
 */
bp_status spectral_survey_colour(const struct spectral_survey *sample, struct colour_fit colour[3], bp_error *error)
{
	for (int c = 0; c < 3; c++) {
		const bp_status status = robust_fit(sample->x, sample->y[c], sample->n, &colour[c], error);
		if (status)
			return status;
	}
	return BP_OK;
}

/*
 * Where the logarithm turns linear: a hundredth of the geometric mean of the median and the 85 % point of all channels' values.
 * The median alone is too low for mirrors and too high for matte white, a higher point the other way round (VARIANTS.md).
 * What lies below 2^-24 of the largest value counts as that: so the unit is at least 2^-31 of the largest, and where half of a
 * table is dark it does not hang on how dark. Square roots are exact to the last bit, powers would not be.
 */
double spectral_survey_unit(struct spectral_survey *sample, const struct lattice *lattice)
{
	double *v = sample->y[0];
	const size_t last = 3 * sample->n - 1, half = last / 2, high = last / 20 * 17 + last % 20 * 17 / 20;
	const double median = select_kth(v, last + 1, half);
	const double upper = select_kth(v + half, last + 1 - half, high - half);
	/* Seldom asked for: a pass over the table. */
	const bool bright = lattice->most > 0 && median >= lattice->most * 0x1p-24 && median > 0;
	const double largest = bright ? lattice->most : lattice_largest(lattice), least = largest * 0x1p-24;

	if (largest == 0)
		return 1;
	const double unit = sqrt(fmax(median, least)) * sqrt(fmax(upper, least)) / 100;
	return fmin(fmax(unit, SPECTRAL_UNIT_LEAST), SPECTRAL_UNIT_MOST);
}

void spectral_survey_order(const struct spectral_survey *sample, int order[3])
{
	double sum[3] = {0};
	for (int c = 0; c < 3; c++) {
		for (size_t i = 0; i < sample->n; i++)
			sum[c] += sample->y[c][i];
		int at = c;
		for (; at > 0 && sum[order[at - 1]] < sum[c]; at--)
			order[at] = order[at - 1];
		order[at] = c;
	}
}
