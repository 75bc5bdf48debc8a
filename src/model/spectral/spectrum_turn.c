#include "spectrum_turn.h"

#include <stdlib.h>
#include <string.h>

#include "clones.h"
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

/* Asks for lanes of the eighth row from here, on or back: lanes of a row are far from those of the next. */
static ALWAYS_INLINE void lanes_ask(const float *here, ptrdiff_t row, size_t count)
{
	memory_ask(here, 8 * row * (ptrdiff_t)sizeof *here);
	memory_ask(here + count - 1, 8 * row * (ptrdiff_t)sizeof *here);
}

/* The harmonics of `count` lanes, at most SPECTRUM_BLOCK, from those of the spectrum, rows in reverse. */
static ALWAYS_INLINE void lanes_turn(struct spectrum_turn *t, const float *in, size_t count, float *out)
{
	const struct lattice_dims d = t->dims;
	const size_t rows = (size_t)d.theta_h * d.theta_d, lanes = d.phi_d;

	if (count < SPECTRUM_BLOCK)
		memset(t->plane, 0, rows * SPECTRUM_BLOCK * sizeof *t->plane);
	for (size_t r = 0; r < rows; r++) {
		const float *from = in + r * lanes;
		float *restrict to = t->plane + (size_t)t->inverse->place[r] * SPECTRUM_BLOCK;
		lanes_ask(from, (ptrdiff_t)lanes, count);
		for (size_t q = 0; q < count; q++)
			to[q] = from[q] * t->inverse->gain[r];
	}
	spectral_kernels_get()->cdf97_plane(t->plane, d.theta_h, d.theta_d, t->inverse->levels, 0);
	for (size_t r = 0; r < rows; r++) {
		float *to = out + (rows - 1 - r) * lanes;
		lanes_ask(to, -(ptrdiff_t)lanes, count);
		memcpy(to, t->plane + r * SPECTRUM_BLOCK, count * sizeof *out);
	}
}

void spectrum_turned(struct spectrum_turn *t, const float *in, float *out)
{
	const size_t lanes = t->dims.phi_d;
	size_t q = 0;

	for (; q + SPECTRUM_BLOCK <= lanes; q += SPECTRUM_BLOCK) /* a count that the compiler knows */
		lanes_turn(t, in + q, SPECTRUM_BLOCK, out + q);
	if (q < lanes)
		lanes_turn(t, in + q, lanes - q, out + q);
	spectrum_wavelets(t->spectrum, out);
}
