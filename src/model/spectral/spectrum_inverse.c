#include "spectrum_inverse.h"

#include <stdlib.h>

#include "error.h"

/* One axis of `here` coefficients of one step, coarse ones first: the place of the i-th among them, and its gain in that step. */
static uint32_t step_place(uint32_t i, uint32_t here, float *gain)
{
	const uint32_t low = (here + 1) / 2;
	/* As floats, because the forward transform's are. */
	*gain = i < low ? 1 / SPECTRUM_GAIN : SPECTRUM_GAIN;
	return i < low ? 2 * i : 2 * (i - low) + 1;
}

static void places_fill(struct spectrum_inverse *t)
{
	const struct lattice_dims d = t->dims;
	const double coarser =
		(double)(1 / SPECTRUM_GAIN) * (double)(1 / SPECTRUM_GAIN); /* what every later step does along both axes */

	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			/* The coarsest step whose coefficients reach so far has it; the last one's low ones are of the coarsest band. */
			uint32_t l = 0;
			while (l < t->levels && i < spectrum_extent(d.theta_h, l + 1) && j < spectrum_extent(d.theta_d, l + 1))
				l++;
			float gain[2] = {1, 1};
			const uint32_t y = l < t->levels ? step_place(i, spectrum_extent(d.theta_h, l), &gain[0]) : i;
			const uint32_t x = l < t->levels ? step_place(j, spectrum_extent(d.theta_d, l), &gain[1]) : j;
			double product = (double)gain[0] * (double)gain[1];
			t->place[i * d.theta_d + j] = (y << l) * d.theta_d + (x << l);
			for (uint32_t k = 0; k < l; k++)
				product *= coarser;
			t->gain[i * d.theta_d + j] = (float)product;
		}
}

bp_status spectrum_inverse_create(struct lattice_dims d, struct spectrum_inverse **out, bp_error *error)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d;
	const size_t bytes = sizeof(struct spectrum_inverse) + rows * (sizeof(uint32_t) + sizeof(float)) + d.phi_d * sizeof(float);
	struct spectrum_inverse *t = malloc(bytes);

	if (!t)
		return error_memory(error, bytes);
	t->dims = d;
	t->levels = spectrum_levels(d.theta_h, d.theta_d);
	t->gain = (float *)(t->place + rows);
	t->harmonic = t->gain + rows;
	places_fill(t);
	for (uint32_t m = 0; m < d.phi_d; m++)
		t->harmonic[m] = 1;
	*out = t;
	return BP_OK;
}
