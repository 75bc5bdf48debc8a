#include "spectrum.h"

#include <stdlib.h>

#include "error.h"
#include "cosines.h"
#include "spans.h"
#include "spectral_kernels.h"

struct spectrum {
	struct lattice_dims dims;
	uint32_t levels;
	struct cosines *cosines;
	struct span_cosines *cut;
	uint16_t *span;  /* of every row */
	float scratch[]; /* for the wavelets; behind it the spans */
};

uint32_t spectrum_levels(uint32_t theta_h, uint32_t theta_d)
{
	uint32_t n = theta_h < theta_d ? theta_h : theta_d, levels = 0;
	while ((n + 1) / 2 >= 8) {
		n = (n + 1) / 2;
		levels++;
	}
	return levels;
}

bp_status spectrum_create(struct lattice_dims dims, float limit, struct spectrum **out, bp_error *error)
{
	const size_t longest = dims.theta_h > dims.theta_d ? dims.theta_h : dims.theta_d, rows = (size_t)dims.theta_h * dims.theta_d;
	const size_t bytes = sizeof(struct spectrum) + 24 * longest * sizeof(float) + rows * sizeof(uint16_t);
	struct spectrum *t = malloc(bytes);

	if (!t)
		return error_memory(error, bytes);
	*t = (struct spectrum){.dims = dims, .levels = spectrum_levels(dims.theta_h, dims.theta_d)};
	t->span = (uint16_t *)(t->scratch + 24 * longest);
	spans_find(dims, limit, t->span);
	bp_status status = cosines_create(dims.phi_d, &t->cosines, error);
	if (!status)
		status = span_cosines_create(dims.phi_d, t->span, rows, dims.phi_d, false, &t->cut, error);
	if (status)
		spectrum_free(t);
	else
		*out = t;
	return status;
}

void spectrum_free(struct spectrum *t)
{
	if (!t)
		return;
	cosines_free(t->cosines);
	span_cosines_free(t->cut);
	free(t);
}

const uint16_t *spectrum_spans(const struct spectrum *t) { return t->span; }

/* The cosines along all rows of phi_d: runs of whole rows at once, those that are cut one by one. */
static void rows_forward(struct spectrum *t, float *table, float base)
{
	const size_t p = t->dims.phi_d, rows = (size_t)t->dims.theta_h * t->dims.theta_d;

	for (size_t r = 0, run; r < rows; r += run) {
		run = 0;
		while (r + run < rows && t->span[r + run] == p)
			run++;
		cosines_forward(t->cosines, table + r * p, run, base);
		for (; r + run < rows && t->span[r + run] < p; run++)
			span_forward(t->cut, t->span[r + run], base, table + (r + run) * p);
	}
}

void spectrum_wavelets(struct spectrum *t, float *harmonics)
{
	const struct spectral_kernels *kernels = spectral_kernels_get();
	const size_t p = t->dims.phi_d, slice = t->dims.theta_d * p;
	size_t rows = t->dims.theta_h, columns = t->dims.theta_d;

	for (uint32_t l = 0; l < t->levels; l++) {
		for (size_t i = 0; i < rows; i++)
			kernels->cdf97_forward(harmonics + i * slice, columns, p, p, t->scratch);
		kernels->cdf97_forward(harmonics, rows, slice, columns * p, t->scratch);
		rows = (rows + 1) / 2;
		columns = (columns + 1) / 2;
	}
}

void spectrum_forward(struct spectrum *t, float *table, float base)
{
	rows_forward(t, table, base);
	spectrum_wavelets(t, table);
}
