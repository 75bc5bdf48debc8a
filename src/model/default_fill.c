/*
 * default_fill.c: invalid cells get what costs the fewest coefficients: a membrane through the valid cells in all three
 * angles. A pyramid per theta_h slice (fill.h) gives the large shapes; sweeps over the whole table then join the slices.
 *
 * Two dimensions alone are not enough: slices that were filled one by one differ where nothing was measured, and the
 * theta_h wavelets pay for it (7 % of a record).
 */
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "default_model.h"
#include "fill.h"
#include "kernels.h"

enum {
	SWEEPS = 16, /* 20 take a quarter more time and save 0.3 % of the error; 12 cost 1 % */
	PIECE = 8,
};

/* A piece of a row with invalid cells: a whole number of PIECEs long, but for the row's end. */
struct run {
	uint32_t row, first, count, filled; /* filled: where its marks begin */
};

struct runs {
	struct run *run;
	float *filled; /* 1 where a cell is to be filled, 0 where not */
	uint32_t count;
};

/* All of the table, in order; and present[row]: no cell is invalid. */
static bp_status runs_make(struct lattice_dims d, const uint8_t *valid, uint8_t *present, struct runs *out, bp_error *error)
{
	const size_t p = d.phi_d, rows = (size_t)d.theta_h * d.theta_d;
	uint32_t run_count = 0, mark_count = 0;

	for (int counting = 1; counting >= 0; counting--) {
		uint32_t n = 0, marks = 0;
		for (size_t r = 0; r < rows; r++) {
			const uint8_t *row = valid + r * p;
			present[r] = !memchr(row, 0, p);
			for (size_t k = 0, before = 0; k < p && !present[r]; k += PIECE) {
				const size_t length = k + PIECE < p ? PIECE : p - k;
				if (!memchr(row + k, 0, length)) {
					before = 0;
					continue;
				}
				if (!before && !counting)
					out->run[n] = (struct run){(uint32_t)r, (uint32_t)k, 0, marks};
				n += !before;
				before = 1;
				for (size_t q = k; q < k + length && !counting; q++)
					out->filled[marks + q - k] = row[q] ? 0 : 1;
				if (!counting)
					out->run[n - 1].count += (uint32_t)length;
				marks += (uint32_t)length;
			}
		}
		if (!counting)
			break;
		run_count = n;
		mark_count = marks;
		out->run = malloc((run_count + 1) * sizeof *out->run);
		out->filled = malloc((mark_count + 1) * sizeof *out->filled);
		if (!out->run || !out->filled)
			return error_memory(error, (mark_count + 1) * sizeof *out->filled);
	}
	out->count = run_count;
	return BP_OK;
}

/* One sweep over the runs, forwards or backwards; mirrored at the table's ends. */
static void sweep(struct lattice_dims d, const struct runs *runs, int backwards, float *table, float *scratch)
{
	const struct kernels *kernels = kernels_get();
	const ptrdiff_t p = d.phi_d, slice = (ptrdiff_t)d.theta_d * p;

	for (uint32_t n = 0; n < runs->count; n++) {
		const struct run *run = &runs->run[backwards ? runs->count - 1 - n : n];
		const uint32_t i = run->row / d.theta_d, j = run->row % d.theta_d, end = run->first + run->count;
		float *x = table + (size_t)run->row * d.phi_d + run->first;
		const float *const neighbour[4] = {
			j ? x - p : x + p,
			j + 1 < d.theta_d ? x + p : x - p,
			i ? x - slice : x + slice,
			i + 1 < d.theta_h ? x + slice : x - slice,
		};
		kernels->default_smooth(x, runs->filled + run->filled, neighbour, run->count, run->first ? x[-1] : x[0],
		                        end < d.phi_d ? x[run->count] : x[run->count - 1], scratch);
	}
}

bp_status default_fill(struct lattice_dims d, const uint8_t *valid, float *const table[3], bp_error *error)
{
	const size_t p = d.phi_d, rows = (size_t)d.theta_h * d.theta_d, slice = d.theta_d * p;
	uint8_t *present = malloc(rows);
	float *scratch = malloc((p + 2) * sizeof *scratch);
	struct runs runs = {0};
	struct fill *fill = NULL;
	bp_status status = present && scratch ? fill_create(d.theta_d, d.phi_d, false, false, &fill, error) : error_memory(error, rows);

	if (!status)
		status = runs_make(d, valid, present, &runs, error);
	for (int c = 0; !status && c < 3; c++) {
		float empty = 0;
		for (size_t i = 0; i < d.theta_h; i++) {
			if (memchr(present + i * d.theta_d, 0, d.theta_d))
				fill_plane(fill, table[c] + i * slice, valid + i * slice, empty);
			empty = table[c][i * slice]; /* a slice without a valid cell is flat */
		}
		for (int s = 0; s < SWEEPS; s++)
			sweep(d, &runs, s % 2, table[c], scratch);
	}
	fill_free(fill);
	free(runs.run);
	free(runs.filled);
	free(present);
	free(scratch);
	return status;
}
