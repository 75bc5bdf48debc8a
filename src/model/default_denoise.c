/*
 * default_denoise.c: what noise alone would explain is drawn towards 0 (block shrinkage: Cai and Silverman 2001).
 *
 *     kept = c max(0, 1 - LAMBDA sigma^2 / mean square of the coefficients around c)
 *
 * The noise is estimated from the table itself, by medians of the finest diagonal band, in which smooth materials
 * have next to nothing: sigma = scale(theta_d) * factor(harmonic). theta_d, because measurements grow noisy towards
 * grazing angles; harmonics, because faults that are constant along phi_d are in the first one only. An orthonormal transform
 * spreads white noise evenly over its bands, so the estimate serves all of them.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "default_model.h"
#include "kernels.h"
#include "select.h"
#include "spectrum.h"

static const float LAMBDA = 4;
static const double NORMAL_MEDIAN = 0.6745; /* of |x| for a standard normal x */
static const float NOISE_LEAST = 0.004f;    /* in log2 units: below this sigma nothing is done */

struct noise {
	float *scale;  /* per theta_d column of the finest bands */
	float *factor; /* per lane */
};

static bp_status noise_estimate(struct lattice_dims d, const float *c, struct noise *noise, bp_error *error)
{
	const uint32_t rows = d.theta_h / 2, columns = d.theta_d / 2, row0 = d.theta_h - rows, column0 = d.theta_d - columns;
	const uint32_t lanes = d.phi_d, even = (d.phi_d + 1) / 2, low = even / 5; /* lanes low.. of either kind are used for the scale */
	const size_t room = (size_t)rows * (lanes > columns ? lanes : columns);
	double *sample = malloc(room * sizeof *sample);

	if (!sample)
		return error_memory(error, room * sizeof *sample);
	for (uint32_t x = 0; x < columns; x++) {
		size_t n = 0;
		for (uint32_t y = 0; y < rows; y++) {
			const float *row = c + ((size_t)(row0 + y) * d.theta_d + column0 + x) * d.phi_d;
			for (uint32_t q = 0; q < lanes; q++)
				if ((q < even ? q : q - even) >= low && (q + y) % 4 == 0)
					sample[n++] = (double)fabsf(row[q]);
		}
		noise->scale[x] = n ? (float)(select_kth(sample, n, n / 2) / NORMAL_MEDIAN) + 1e-12f : 1e-12f;
	}
	for (uint32_t q = 0; q < lanes; q++) {
		size_t n = 0;
		for (uint32_t y = 0; y < rows; y++)
			for (uint32_t x = (y + q) % 2; x < columns; x += 2)
				sample[n++] = (double)(fabsf(c[((size_t)(row0 + y) * d.theta_d + column0 + x) * d.phi_d + q]) / noise->scale[x]);
		noise->factor[q] = n ? (float)(select_kth(sample, n, n / 2) / NORMAL_MEDIAN) : 0;
	}
	free(sample);
	return BP_OK;
}

/* A band of wavelet coefficients as a rectangle of rows and columns. */
struct rectangle {
	uint32_t row, column, rows, columns;
};

static void band_shrink(struct lattice_dims d, const float *c, struct rectangle band, const struct noise *noise, float *threshold, float *out)
{
	const struct kernels *kernels = kernels_get();
	const uint32_t columns = d.theta_d / 2;

	for (uint32_t x = 0; x < band.columns; x++) {
		const uint32_t at = (uint32_t)((uint64_t)x * columns / band.columns);
		for (uint32_t q = 0; q < d.phi_d; q++) {
			const float sigma = noise->scale[at] * noise->factor[q];
			threshold[q] = LAMBDA * sigma * sigma;
		}
		for (uint32_t y = 0; y < band.rows; y++) {
			const float *rows[9];
			for (int r = 0; r < 9; r++) {
				const int64_t yy = (int64_t)y + r / 3 - 1, xx = (int64_t)x + r % 3 - 1;
				const int inside = yy >= 0 && yy < band.rows && xx >= 0 && xx < band.columns;
				rows[r] = inside ? c + ((size_t)(band.row + yy) * d.theta_d + (size_t)(band.column + xx)) * d.phi_d : NULL;
			}
			kernels->default_shrink(rows, threshold, d.phi_d, out + ((size_t)(band.row + y) * d.theta_d + band.column + x) * d.phi_d);
		}
	}
}

bp_status default_denoise(struct lattice_dims d, float *coefficient, bool *noisy, bp_error *error)
{
	const size_t cells = lattice_cells(d);
	struct noise noise = {calloc(d.theta_d, sizeof(float)), calloc(d.phi_d, sizeof(float))};
	float *out = NULL, *threshold = malloc(d.phi_d * sizeof *threshold), largest = 0;
	bp_status status = BP_OK;

	if (!noise.scale || !noise.factor || !threshold) {
		status = error_memory(error, d.phi_d * sizeof *threshold);
		goto out;
	}
	if (!spectrum_levels(d.theta_h, d.theta_d))
		goto out;
	status = noise_estimate(d, coefficient, &noise, error);
	if (status)
		goto out;
	for (uint32_t x = 0; x < d.theta_d / 2; x++)
		largest = noise.scale[x] > largest ? noise.scale[x] : largest;
	if (largest < NOISE_LEAST)
		goto out;
	out = malloc(cells * sizeof *out);
	if (!out) {
		status = error_memory(error, cells * sizeof *out);
		goto out;
	}
	uint32_t rows = d.theta_h, columns = d.theta_d;
	for (uint32_t l = spectrum_levels(rows, columns); l > 0; l--) {
		const uint32_t r = (rows + 1) / 2, c = (columns + 1) / 2;
		band_shrink(d, coefficient, (struct rectangle){0, c, r, columns - c}, &noise, threshold, out);
		band_shrink(d, coefficient, (struct rectangle){r, 0, rows - r, c}, &noise, threshold, out);
		band_shrink(d, coefficient, (struct rectangle){r, c, rows - r, columns - c}, &noise, threshold, out);
		rows = r;
		columns = c;
	}
	/* The coarsest band is kept as it is. */
	for (uint32_t y = 0; y < rows; y++)
		memcpy(out + (size_t)y * d.theta_d * d.phi_d, coefficient + (size_t)y * d.theta_d * d.phi_d, (size_t)columns * d.phi_d * sizeof *out);
	memcpy(coefficient, out, cells * sizeof *out);
	*noisy = true;
out:
	free(out);
	free(threshold);
	free(noise.scale);
	free(noise.factor);
	return status;
}
