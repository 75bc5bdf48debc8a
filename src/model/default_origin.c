/*
 * default_origin.c: is a table decoded? See default_origin.h.
 *
 * Most vectors of the three channels' coefficients that are not 0 have one level of 1 and nothing else. Their length is the same
 * whatever the axes are, and nothing is shorter: a histogram of lengths tells a decoded table from any other.
 */
#include "default_origin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "fast_math.h"

enum {
	BIN_SHIFT = 17, /* of the bits of a squared length: 64 bins to the octave, 0.5 % of a length wide */
	BINS = 1 << (31 - BIN_SHIFT),
	PEAK_LEAST = 24, /* vectors in the peak: fewer prove nothing */
};
static const float LENGTH_LEAST = 0x1p-12f; /* well above the rounding errors of logarithms in float */

void default_origin_free(struct default_origin *o)
{
	free(o->known);
	free(o->exact);
	*o = (struct default_origin){0};
}

/* ---- which coefficients are exact ---- */

/* One step of the wavelets along a line of marks: what reaches a mark is marked, low coefficients first. */
static void marks_step(uint8_t *x, size_t n, size_t stride, uint8_t *scratch)
{
	for (size_t i = 0; i < n; i++)
		scratch[i] = x[i * stride];
	for (size_t i = 0; i < n; i++) {
		const ptrdiff_t reach = i % 2 ? 3 : 4, last = (ptrdiff_t)n - 1; /* the 7 and 9 taps of the filters */
		uint8_t any = 0;
		for (ptrdiff_t k = (ptrdiff_t)i - reach; k <= (ptrdiff_t)i + reach; k++) {
			ptrdiff_t at = k < 0 ? -k : k;
			at = at > last ? 2 * last - at : at;
			any |= scratch[at < 0 ? 0 : at];
		}
		x[(i % 2 ? (n + 1) / 2 + i / 2 : i / 2) * stride] = any;
	}
}

static bp_status exact_mark(struct lattice_dims d, const uint8_t *known, uint8_t *exact, bp_error *error)
{
	const size_t p = d.phi_d, cells = (size_t)d.theta_h * d.theta_d;
	uint32_t rows = d.theta_h, columns = d.theta_d;
	uint8_t *scratch = malloc(rows > columns ? rows : columns);

	if (!scratch)
		return error_memory(error, rows > columns ? rows : columns);
	for (size_t r = 0; r < cells; r++)
		exact[r] = memchr(known + r * p, 0, p) != NULL;
	for (uint32_t l = spectrum_levels(d.theta_h, d.theta_d); l > 0; l--) {
		for (uint32_t i = 0; i < rows; i++)
			marks_step(exact + i * d.theta_d, columns, 1, scratch);
		for (uint32_t j = 0; j < columns; j++)
			marks_step(exact + j, rows, d.theta_d, scratch);
		rows = (rows + 1) / 2;
		columns = (columns + 1) / 2;
	}
	for (size_t r = 0; r < cells; r++)
		exact[r] = !exact[r];
	free(scratch);
	return BP_OK;
}

/* ---- is there a grid? ---- */

static inline float length2(float *const x[3], size_t at)
{
	return x[0][at] * x[0][at] + x[1][at] * x[1][at] + x[2][at] * x[2][at];
}

static inline uint32_t bin_of(float length)
{
	return bits_of_float(length * length) >> BIN_SHIFT;
}

/*
 * The length of vectors of level 1, to half a percent; 0 where there is no such peak. In a measurement's histogram every bin has more below
 * it; below this peak there are strays at most, of cells that are not known. Every third row will do where there are many.
 */
static float peak_find(struct lattice_dims d, float *const x[3], const uint8_t *exact, uint32_t *up_to)
{
	const size_t p = d.phi_d, rows = (size_t)d.theta_h * d.theta_d, every = rows > 1000 ? 3 : 1;
	uint32_t best = 0, most = 0;

	memset(up_to, 0, (BINS + 1) * sizeof *up_to);
	for (size_t r = every / 2; r < rows; r += every)
		for (size_t at = r * p; exact[r] && at < (r + 1) * p; at++)
			up_to[(bits_of_float(length2(x, at)) >> BIN_SHIFT) + 1]++;
	for (uint32_t b = 0; b < BINS; b++)
		up_to[b + 1] += up_to[b];
	for (uint32_t b = bin_of(LENGTH_LEAST); b + 2 < BINS; b++) {
		const uint32_t three = up_to[b + 2] - up_to[b - 1];
		if (three < PEAK_LEAST || three <= most || three < (up_to[BINS] - up_to[b]) / 16)
			continue;
		const float length = sqrtf(float_of_bits(b << BIN_SHIFT));
		if (up_to[bin_of(0.9f * length)] - up_to[bin_of(0.4f * length)] <= three / 4) {
			most = three;
			best = b;
		}
	}
	return best ? sqrtf(float_of_bits((best << BIN_SHIFT) + (1u << BIN_SHIFT) / 2)) : 0;
}

bp_status default_origin_find(const struct lattice *lattice, float *const x[3], const float base[3], const float rotation[3][3],
                              struct default_origin *o, bp_error *error)
{
	const struct lattice_dims d = lattice->dims;
	const size_t cells = lattice_cells(d), rows = (size_t)d.theta_h * d.theta_d;
	uint32_t *bins = malloc((BINS + 1) * sizeof *bins);
	bool found = false;
	bp_status status = BP_OK;

	*o = (struct default_origin){.exact = malloc(rows), .missed = INFINITY};
	if (!bins || !o->exact)
		status = error_memory(error, BINS * sizeof *bins);
	if (!status)
		status = exact_mark(d, lattice->valid, o->exact, error);
	if (status || peak_find(d, x, o->exact, bins) == 0)
		goto out;
	/* From here on it is worth a look at every value. */
	o->known = malloc(cells);
	if (!o->known) {
		status = error_memory(error, cells);
		goto out;
	}
	for (size_t i = 0; i < cells; i++)
		o->known[i] = lattice->valid[i] && lattice->rgb[0][i] > 0 && lattice->rgb[1][i] > 0 && lattice->rgb[2][i] > 0;
	status = exact_mark(d, o->known, o->exact, error);
	const struct grid_evidence evidence = {d, x, o->exact};
	const float length = status ? 0 : peak_find(d, x, o->exact, bins);
	if (length > 0)
		status = default_grid_find(&evidence, length, rotation, &o->grid, &found, error);
	if (status || !found)
		goto out;
	o->missed = default_grid_missed(&evidence, &o->grid);
	/* A constant of 1 is this much in harmonic 0's coarsest band. */
	const float gain = sqrtf((float)d.phi_d) * (float)(1u << spectrum_levels(d.theta_h, d.theta_d));
	for (int c = 0; c < 3; c++)
		o->base[c] = base[c] + (o->grid.axis[0][c] * o->grid.offset[0] + o->grid.axis[1][c] * o->grid.offset[1] + o->grid.axis[2][c] * o->grid.offset[2]) / gain;
out:
	free(bins);
	return status;
}
