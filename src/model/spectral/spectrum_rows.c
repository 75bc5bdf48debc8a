#include "spectrum_rows.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "spans.h"
#include "spectral_kernels.h"

enum { STEP = 8 }; /* lanes of a kind are a multiple of it */
_Static_assert((int)SPAN_ROWS >= (int)SPECTRUM_BLOCK && SPECTRUM_BLOCK % STEP == 0, "rows asked for at once have room");

/*
 * A field after the wavelets: planes of the rows that are wanted, [plane][row][SPECTRUM_BLOCK], their lanes first of even
 * harmonics, then of odd ones, of either kind up to the last with a term.
 */
struct lanes {
	float *value;
	uint32_t even, odd, planes;
};

struct spectrum_rows {
	struct lattice_dims dims;
	const struct spectrum_inverse *inverse;
	bool half;
	uint32_t high, wide; /* rows that are wanted: along theta_h, along theta_d */
	struct span_cosines *cosines;
	struct lanes field[SPECTRUM_FIELDS];
	float *plane;   /* half: a whole one, before its wanted rows are taken */
	float *line;    /* half: whole rows, before every second cell is taken */
	uint16_t *span; /* of the rows that are wanted */
	float lanes[];  /* of a few rows, side by side; behind them the two arrays above */
};

/* Where row r of a half table is among all. */
static uint32_t row_of_half(const struct spectrum_rows *t, uint32_t r)
{
	return 2 * (r / t->wide * t->dims.theta_d + r % t->wide);
}

bp_status spectrum_rows_create(const struct spectrum_inverse *inverse, float limit, uint32_t harmonics, bool half,
                               struct spectrum_rows **out, bp_error *error)
{
	const struct lattice_dims d = inverse->dims;
	const size_t rows = (size_t)d.theta_h * d.theta_d, lanes = SPAN_ROWS * (d.phi_d + 4 * STEP),
				 line = SPAN_ROWS * (size_t)d.phi_d;
	const size_t bytes = sizeof(struct spectrum_rows) + (lanes + line) * sizeof(float) + rows * sizeof(uint16_t);
	const size_t plane_bytes = half ? rows * SPECTRUM_BLOCK * sizeof(float) : 0;
	struct spectrum_rows *t = malloc(bytes);

	if (!t)
		return error_memory(error, bytes);
	*t = (struct spectrum_rows){
		.dims = d,
		.inverse = inverse,
		.half = half,
		.high = half ? d.theta_h / 2 : d.theta_h,
		.wide = half ? d.theta_d / 2 : d.theta_d,
		.plane = half ? memory_alloc(plane_bytes) : NULL,
	};
	t->line = t->lanes + lanes;
	t->span = (uint16_t *)(t->line + line);
	bp_status status = t->plane || !half ? BP_OK : error_memory(error, plane_bytes);
	if (!status) {
		spans_find(d, limit, t->span);
		for (uint32_t r = 0; r < t->high * t->wide && half; r++) /* never before where it is read */
			t->span[r] = t->span[row_of_half(t, r)];
		status = span_cosines_create(d.phi_d, t->span, (size_t)t->high * t->wide, harmonics, true, &t->cosines, error);
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
	for (int f = 0; f < SPECTRUM_FIELDS; f++)
		free(t->field[f].value);
	span_cosines_free(t->cosines);
	free(t->plane);
	free(t);
}

/* The lanes first..first + SPECTRUM_BLOCK - 1 of the rows that are wanted, to out[row][SPECTRUM_BLOCK]. */
static void plane_invert(const struct spectrum_rows *t, const struct spectrum_term *terms, const uint32_t *start,
                         const struct lanes *lanes, uint32_t first, float *out)
{
	const struct lattice_dims d = t->dims;
	float *plane = t->half ? t->plane : out;

	memset(plane, 0, (size_t)d.theta_h * d.theta_d * SPECTRUM_BLOCK * sizeof *plane);
	for (uint32_t q = 0; q < SPECTRUM_BLOCK; q++) {
		const uint32_t lane = first + q, m = lane < lanes->even ? 2 * lane : 2 * (lane - lanes->even) + 1;
		if (m >= d.phi_d)
			continue;
		for (uint32_t i = start[m]; i < start[m + 1]; i++)
			plane[(size_t)terms[i].place * SPECTRUM_BLOCK + q] = terms[i].value;
	}
	spectral_kernels_get()->cdf97_plane(plane, d.theta_h, d.theta_d, t->inverse->levels, t->half);
	for (uint32_t r = 0; r < t->high * t->wide && t->half; r++)
		memcpy(out + (size_t)r * SPECTRUM_BLOCK, plane + (size_t)row_of_half(t, r) * SPECTRUM_BLOCK,
		       SPECTRUM_BLOCK * sizeof *plane);
}

/* Lanes up to the last harmonic of a parity with a term. */
static uint32_t lanes_needed(const uint32_t *start, uint32_t harmonics, uint32_t parity)
{
	uint32_t count = 0;
	for (uint32_t m = parity; m < harmonics; m += 2)
		if (start[m + 1] > start[m])
			count = m / 2 + 1;
	return (count + STEP - 1) / STEP * STEP;
}

bp_status spectrum_rows_field(struct spectrum_rows *t, int field, const struct spectrum_term *terms, const uint32_t *start,
                              bp_error *error)
{
	struct lanes *lanes = &t->field[field];

	free(lanes->value);
	lanes->even = lanes_needed(start, t->dims.phi_d, 0);
	lanes->odd = lanes_needed(start, t->dims.phi_d, 1);
	lanes->planes = (lanes->even + lanes->odd + SPECTRUM_BLOCK - 1) / SPECTRUM_BLOCK;
	const size_t plane = (size_t)t->high * t->wide * SPECTRUM_BLOCK, bytes = lanes->planes * plane * sizeof(float);
	lanes->value = memory_alloc(bytes ? bytes : 1);
	if (!lanes->value)
		return error_memory(error, bytes);
	for (uint32_t n = 0; n < lanes->planes; n++)
		plane_invert(t, terms, start, lanes, n * SPECTRUM_BLOCK, lanes->value + n * plane);
	return BP_OK;
}

/* Of `count` lanes of some rows, those up to the last that is not 0 in all of them, in steps of a few. */
static uint32_t lanes_used(const float *in, size_t stride, uint32_t rows, uint32_t count)
{
	for (; count > 0; count -= STEP) {
		uint32_t any = 0, bits[STEP];
		for (uint32_t r = 0; r < rows; r++) {
			memcpy(bits, in + r * stride + count - STEP, sizeof bits);
			for (int q = 0; q < STEP; q++)
				any |= bits[q] << 1; /* but for the sign */
		}
		if (any)
			break;
	}
	return count;
}

void spectrum_rows_cells(struct spectrum_rows *t, int field, uint32_t first, uint32_t count, float *out, size_t stride)
{
	const struct lanes *lanes = &t->field[field];
	const uint32_t p = t->dims.phi_d;
	const uint16_t *span = t->span + first;
	const size_t width = (size_t)lanes->planes * SPECTRUM_BLOCK, plane = (size_t)t->high * t->wide * SPECTRUM_BLOCK;
	const size_t apart = t->half ? p : stride;
	float *cells = t->half ? t->line : out;

	for (uint32_t n = 0; n < lanes->planes; n++) {
		const float *from = lanes->value + n * plane + (size_t)first * SPECTRUM_BLOCK;
		for (uint32_t r = 0; r < count; r++, from += SPECTRUM_BLOCK) {
			/* So many planes at once no processor foresees. */
			memory_ask(from, sizeof *from * SPAN_ROWS * SPECTRUM_BLOCK);
			memcpy(t->lanes + r * width + n * SPECTRUM_BLOCK, from, SPECTRUM_BLOCK * sizeof *from);
		}
	}
	for (uint32_t r = 0, run; r < count; r += run) {
		for (run = 1; r + run < count && span[r + run] == span[r];)
			run++;
		const float *even = t->lanes + r * width, *odd = even + lanes->even;
		const struct span_lanes in = {even, odd, width, lanes_used(even, width, run, lanes->even),
		                              lanes_used(odd, width, run, lanes->odd)};
		span_inverse(t->cosines, span[r], &in, run, cells + r * apart, apart);
	}
	for (uint32_t r = 0; r < count && t->half; r++)
		for (uint32_t k = 0; k < p / 2; k++)
			out[r * stride + k] = cells[r * apart + 2 * k];
}

void spectrum_rows_seen(const struct spectrum_rows *t, uint32_t r, uint32_t *first, uint32_t *count)
{
	const uint32_t every = t->half ? 2 : 1, span = t->span[r], begin = (t->dims.phi_d - span) / 2;
	/* The last cell of the span, or the one behind it where that one is not wanted. */
	const uint32_t last = (begin + span - 1 + every - 1) / every, most = t->dims.phi_d / every - 1;

	*first = begin / every;
	*count = (last < most ? last : most) - *first + 1;
}
