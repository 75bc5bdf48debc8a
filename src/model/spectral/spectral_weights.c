/* spectral_weights.c: factors from weights. */
#include "spectral_weights.h"

#include <math.h>
#include <stdlib.h>

#include "cosines.h"
#include "error.h"
#include "model/math/fast_math.h"

/* In octaves, -1/2 log2 of the mean of (2 + cos w)/3 over the details of steps 0, 1, 2, in sixteenths; 0 for coarser ones. */
enum { GRADED_STEPS = 3 };
static const float GRADE[GRADED_STEPS] = {9 / 16.0f, 3 / 16.0f, 1 / 16.0f};

static const float EASE_FROM = 0.5f, EASE_OCTAVES = 3; /* VARIANTS.md, "Noise" */

/* Where coefficient i of an axis of n cells lies, in edges of regions from the first one's centre; `level` as in rows_fill. */
static float place(uint32_t n, uint32_t i, uint32_t level, uint32_t levels, float edge)
{
	const uint32_t all = spectrum_extent(n, level), low = level < levels ? spectrum_extent(n, level + 1) : all;
	/* Even cells of the step's line became coarse coefficients, odd ones details. */
	const float cell = level == levels ? (float)i : i < low ? (float)(2 * i) : (float)(2 * (i - low) + 1);
	return fminf(fmaxf((cell + 0.5f) / (float)all * edge - 0.5f, 0), edge - 1);
}

/* Octaves of the details of step `level` along the axes in which coefficient (i, j) is one. */
static float grade(struct lattice_dims d, uint32_t i, uint32_t j, uint32_t level, uint32_t levels)
{
	if (level >= levels || level >= GRADED_STEPS)
		return 0;
	return GRADE[level] * (float)((i >= spectrum_extent(d.theta_h, level + 1)) + (j >= spectrum_extent(d.theta_d, level + 1)));
}

static void rows_fill(struct lattice_dims d, const struct spectral_weights *weights, float *factor)
{
	const uint32_t levels = spectrum_levels(d.theta_h, d.theta_d), edge = spectral_weights_edge(weights);
	const float octaves = weights->graded ? 1 / 2.0f : 1 / 16.0f;

	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			uint32_t level = 0; /* the step whose details it is of; `levels`: none's */
			while (level < levels && i < spectrum_extent(d.theta_h, level + 1) && j < spectrum_extent(d.theta_d, level + 1))
				level++;
			const float y = place(d.theta_h, i, level, levels, (float)edge), x = place(d.theta_d, j, level, levels, (float)edge);
			const uint32_t row = y < (float)(edge - 1) ? (uint32_t)y : edge - 2;
			const uint32_t column = x < (float)(edge - 1) ? (uint32_t)x : edge - 2;
			const float down = y - (float)row, right = x - (float)column;
			const uint8_t *w = weights->weight + row * edge + column;
			const float above = (float)w[0] + right * (float)(w[1] - w[0]),
						below = (float)w[edge] + right * (float)(w[edge + 1] - w[edge]);
			*factor++ =
				fast_exp2f((above + down * (below - above)) * octaves + (weights->graded ? grade(d, i, j, level, levels) : 0));
		}
}

static void harmonics_fill(uint32_t p, bool graded, float *factor)
{
	for (uint32_t m = 0; m < p; m++)
		factor[m] = graded ? (float)sqrt(3 / (2 + cosines_exact(2 * m, p))) : 1;
}

void spectral_weights_ease(struct spectral_weights *weights, float octaves)
{
	const float share = fminf(fmaxf((octaves - EASE_FROM) / EASE_OCTAVES, 0), 1);
	for (int r = 0; r < SPECTRAL_WEIGHTS; r++)
		weights->weight[r] = (uint8_t)(share * (float)weights->weight[r] + 0.5f);
}

bp_status spectral_factors_create(struct lattice_dims d, const struct spectral_weights *weights, struct spectral_factors *out,
                                  bp_error *error)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d, bytes = (rows + d.phi_d) * sizeof(float);

	out->row = malloc(bytes);
	if (!out->row)
		return error_memory(error, bytes);
	out->harmonic = out->row + rows;
	rows_fill(d, weights, out->row);
	harmonics_fill(d.phi_d, weights->graded, out->harmonic);
	return BP_OK;
}

bp_status spectral_inverse_create(struct lattice_dims d, const struct spectral_weights *weights, struct spectrum_inverse **out,
                                  bp_error *error)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d;
	struct spectral_factors factors;
	bp_status status = spectral_factors_create(d, weights, &factors, error);

	if (!status)
		status = spectrum_inverse_create(d, out, error);
	for (size_t r = 0; r < rows && !status; r++)
		(*out)->gain[r] *= factors.row[r];
	for (uint32_t m = 0; m < d.phi_d && !status; m++)
		(*out)->harmonic[m] *= factors.harmonic[m];
	free(factors.row);
	return status;
}

void spectral_factors_divide(struct lattice_dims d, const struct spectral_factors *factors, float *spectrum)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d, lanes = d.phi_d;
	float lane[LATTICE_EXTENT_MAX];

	for (size_t q = 0; q < lanes; q++)
		lane[q] = 1 / factors->harmonic[spectrum_harmonic(d.phi_d, (uint32_t)q)];
	for (size_t r = 0; r < rows; r++) {
		const float inverse = 1 / factors->row[r];
		for (size_t q = 0; q < lanes; q++)
			spectrum[r * lanes + q] *= inverse * lane[q];
	}
}
