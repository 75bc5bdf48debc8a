#include "spectrum_turn.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "spectral_kernels.h"
#include "spectrum_inverse.h"

struct spectrum_turn {
	struct lattice_dims dims;
	struct spectrum *spectrum;
	struct spectrum_inverse *inverse;
	float *plane; /* SPECTRUM_BLOCK lanes of all rows */
};

bp_status spectrum_turn_create(struct spectrum *spectrum, struct lattice_dims dims, struct spectrum_turn **out, bp_error *error)
{
	const size_t bytes = (size_t)dims.theta_h * dims.theta_d * SPECTRUM_BLOCK * sizeof(float);
	struct spectrum_turn *t = calloc(1, sizeof *t);

	if (!t)
		return error_memory(error, sizeof *t);
	t->dims = dims;
	t->spectrum = spectrum;
	t->plane = memory_alloc(bytes);
	const bp_status status = t->plane ? spectrum_inverse_create(dims, &t->inverse, error) : error_memory(error, bytes);
	if (status)
		spectrum_turn_free(t);
	else
		*out = t;
	return status;
}

void spectrum_turn_free(struct spectrum_turn *t)
{
	if (!t)
		return;
	free(t->inverse);
	free(t->plane);
	free(t);
}

/* The harmonics of `count` lanes, at most SPECTRUM_BLOCK, from those of the spectrum, rows in reverse. */
static void lanes_turn(struct spectrum_turn *t, const float *in, size_t count, float *out)
{
	const struct lattice_dims d = t->dims;
	const size_t rows = (size_t)d.theta_h * d.theta_d, lanes = d.phi_d;

	if (count < SPECTRUM_BLOCK)
		memset(t->plane, 0, rows * SPECTRUM_BLOCK * sizeof *t->plane);
	for (size_t r = 0; r < rows; r++) {
		float *to = t->plane + (size_t)t->inverse->place[r] * SPECTRUM_BLOCK;
		for (size_t q = 0; q < count; q++)
			to[q] = in[r * lanes + q] * t->inverse->gain[r];
	}
	spectral_kernels_get()->cdf97_plane(t->plane, d.theta_h, d.theta_d, t->inverse->levels, 0);
	for (size_t r = 0; r < rows; r++)
		memcpy(out + (rows - 1 - r) * lanes, t->plane + r * SPECTRUM_BLOCK, count * sizeof *out);
}

void spectrum_turned(struct spectrum_turn *t, const float *in, float *out)
{
	const size_t lanes = t->dims.phi_d;

	for (size_t q = 0; q < lanes; q += SPECTRUM_BLOCK)
		lanes_turn(t, in + q, lanes - q < SPECTRUM_BLOCK ? lanes - q : SPECTRUM_BLOCK, out + q);
	spectrum_wavelets(t->spectrum, out);
}
