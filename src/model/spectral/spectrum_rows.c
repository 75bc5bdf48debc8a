#include "spectrum_rows.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "spans.h"
#include "spectral_kernels.h"

struct spectrum_rows {
	struct lattice_dims dims;
	const struct spectrum_inverse *inverse;
	bool half;
	uint32_t high, wide; /* rows that are wanted: along theta_h, along theta_d */
	size_t stride;       /* lanes, padded */
	uint16_t *span;
	struct span_cosines *cosines;
	float *plane, *lanes; /* lanes[field][row][stride]: after the wavelets */
	float *line;          /* half: whole rows, before every second cell is taken */
};

bp_status spectrum_rows_create(struct lattice_dims d, const struct spectrum_inverse *inverse, int fields, bool half,
                               struct spectrum_rows **out, bp_error *error)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d;
	struct spectrum_rows *t = calloc(1, sizeof *t);

	if (!t)
		return error_memory(error, sizeof *t);
	t->dims = d;
	t->inverse = inverse;
	t->half = half;
	t->high = half ? d.theta_h / 2 : d.theta_h;
	t->wide = half ? d.theta_d / 2 : d.theta_d;
	t->stride = ((size_t)d.phi_d + SPECTRUM_BLOCK - 1) / SPECTRUM_BLOCK * SPECTRUM_BLOCK;
	const size_t bytes = (size_t)fields * t->high * t->wide * t->stride * sizeof(float);
	t->span = malloc(rows * sizeof *t->span);
	t->plane = memory_alloc(rows * SPECTRUM_BLOCK * sizeof(float));
	t->lanes = memory_alloc(bytes);
	t->line = malloc(SPAN_ROWS * t->stride * sizeof(float));
	bp_status status = t->span && t->plane && t->lanes && t->line ? BP_OK : error_memory(error, bytes);
	if (!status) {
		spans_find(d, t->span);
		status = span_cosines_create(d, t->span, true, &t->cosines, error);
	}
	if (status)
		spectrum_rows_free(t);
	else
		*out = t;
	return status;
}

void spectrum_rows_free(struct spectrum_rows *t)
{
	if (!t)
		return;
	span_cosines_free(t->cosines);
	free(t->span);
	free(t->plane);
	free(t->lanes);
	free(t->line);
	free(t);
}

/* SPECTRUM_BLOCK lanes from `first` on. */
static void lanes_invert(struct spectrum_rows *t, const struct spectrum_term *terms, const uint32_t *start, uint32_t first,
                         float *out)
{
	const struct lattice_dims d = t->dims;
	const uint32_t every = t->half ? 2 : 1, count = d.phi_d - first < SPECTRUM_BLOCK ? d.phi_d - first : SPECTRUM_BLOCK;
	uint32_t used = 0;

	for (uint32_t q = 0; q < count; q++) {
		const uint32_t m = spectrum_harmonic(d.phi_d, first + q);
		if (start[m + 1] > start[m] && !used) {
			used = 1;
			memset(t->plane, 0, (size_t)d.theta_h * d.theta_d * SPECTRUM_BLOCK * sizeof *t->plane);
		}
		for (uint32_t i = start[m]; i < start[m + 1]; i++)
			t->plane[(size_t)terms[i].place * SPECTRUM_BLOCK + q] = terms[i].value;
	}
	if (used)
		spectral_kernels_get()->cdf97_plane(t->plane, d.theta_h, d.theta_d, t->inverse->levels, t->half);
	for (uint32_t i = 0; i < t->high; i++)
		for (uint32_t j = 0; j < t->wide; j++, out += t->stride) {
			if (used)
				memcpy(out, t->plane + ((size_t)i * every * d.theta_d + (size_t)j * every) * SPECTRUM_BLOCK,
				       SPECTRUM_BLOCK * sizeof *out);
			else
				memset(out, 0, SPECTRUM_BLOCK * sizeof *out);
		}
}

void spectrum_rows_field(struct spectrum_rows *t, int field, const struct spectrum_term *terms, const uint32_t *start)
{
	float *lanes = t->lanes + (size_t)field * t->high * t->wide * t->stride;
	for (uint32_t q = 0; q < t->dims.phi_d; q += SPECTRUM_BLOCK)
		lanes_invert(t, terms, start, q, lanes + q);
}

/* One more than the last of the lanes from..to - 1 that is not 0 in one of the rows, in steps of a few; less `from`. */
static uint32_t lanes_used(const float *in, size_t stride, uint32_t rows, uint32_t from, uint32_t to)
{
	enum { STEP = 8 };
	while (to > from) {
		const uint32_t begin = to - from > STEP ? to - STEP : from;
		for (uint32_t r = 0; r < rows; r++)
			for (uint32_t q = begin; q < to; q++)
				if (in[r * stride + q] != 0)
					return to - from;
		to = begin;
	}
	return 0;
}

void spectrum_rows_cells(struct spectrum_rows *t, int field, uint32_t first, uint32_t count, float *out, size_t stride)
{
	const uint32_t p = t->dims.phi_d, every = t->half ? 2 : 1;
	const float *in = t->lanes + ((size_t)field * t->high * t->wide + first) * t->stride;
	float *cells = t->half ? t->line : out;
	const size_t apart = t->half ? t->stride : stride;

	for (uint32_t r = 0, run; r < count; r += run) {
		uint32_t n = 0;
		for (run = 0; r + run < count; run++) {
			const uint32_t i = (first + r + run) / t->wide * every, j = (first + r + run) % t->wide * every;
			const uint32_t here = t->span[i * t->dims.theta_d + j];
			if (run && here != n)
				break;
			n = here;
		}
		const float *row = in + r * t->stride;
		const uint32_t even = lanes_used(row, t->stride, run, 0, (p + 1) / 2),
					   odd = lanes_used(row, t->stride, run, (p + 1) / 2, p);
		span_inverse(t->cosines, n, row, t->stride, run, even, odd, cells + r * apart, apart);
	}
	for (uint32_t r = 0; r < count && t->half; r++)
		for (uint32_t k = 0; k < p / 2; k++)
			out[r * stride + k] = cells[r * apart + 2 * k];
}
