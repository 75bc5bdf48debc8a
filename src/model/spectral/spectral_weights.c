/* spectral_weights.c: factors from weights. */
#include "spectral_weights.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "model/math/fast_math.h"

enum { EDGE = SPECTRAL_WEIGHTS_EDGE };

/* Where coefficient i of an axis of n cells lies, in edges of regions from the first one's centre; `level` as in spectral_weights_factors. */
static float place(uint32_t n, uint32_t i, uint32_t level, uint32_t levels)
{
	const uint32_t all = spectrum_extent(n, level), low = level < levels ? spectrum_extent(n, level + 1) : all;
	/* Even cells of the step's line became coarse coefficients, odd ones details. */
	const float cell = level == levels ? (float)i : i < low ? (float)(2 * i) : (float)(2 * (i - low) + 1);
	return fminf(fmaxf((cell + 0.5f) / (float)all * EDGE - 0.5f, 0), EDGE - 1);
}

void spectral_weights_factors(struct lattice_dims d, const uint8_t weights[SPECTRAL_WEIGHTS], float *factor)
{
	const uint32_t levels = spectrum_levels(d.theta_h, d.theta_d);

	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			uint32_t level = 0; /* the step whose details it is of; `levels`: none's */
			while (level < levels && i < spectrum_extent(d.theta_h, level + 1) && j < spectrum_extent(d.theta_d, level + 1))
				level++;
			const float y = place(d.theta_h, i, level, levels), x = place(d.theta_d, j, level, levels);
			const uint32_t row = y < EDGE - 1 ? (uint32_t)y : EDGE - 2, column = x < EDGE - 1 ? (uint32_t)x : EDGE - 2;
			const float down = y - (float)row, right = x - (float)column;
			const uint8_t *w = weights + row * EDGE + column;
			const float above = (float)w[0] + right * (float)(w[1] - w[0]),
						below = (float)w[EDGE] + right * (float)(w[EDGE + 1] - w[EDGE]);
			*factor++ = fast_exp2f((above + down * (below - above)) / 16);
		}
}

bp_status spectral_weights_apply(const uint8_t weights[SPECTRAL_WEIGHTS], struct spectrum_inverse *inverse, bp_error *error)
{
	const size_t rows = (size_t)inverse->dims.theta_h * inverse->dims.theta_d;
	float *factor = malloc(rows * sizeof *factor);

	if (!factor)
		return error_memory(error, rows * sizeof *factor);
	spectral_weights_factors(inverse->dims, weights, factor);
	for (size_t r = 0; r < rows; r++)
		inverse->gain[r] *= factor[r];
	free(factor);
	return BP_OK;
}

void spectral_weights_divide(struct lattice_dims d, const float *factor, float *spectrum)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d, lanes = d.phi_d;

	for (size_t r = 0; r < rows; r++) {
		const float inverse = 1 / factor[r];
		for (size_t q = 0; q < lanes; q++)
			spectrum[r * lanes + q] *= inverse;
	}
}
