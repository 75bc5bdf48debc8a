/*
 * spectral_fill.c: invalid cells get what costs the fewest coefficients: a membrane through the valid cells in all three
 * angles. A pyramid per theta_h slice (fill.h) gives the large shapes; sweeps over the whole table then join the slices.
 *
 * Two dimensions alone are not enough: slices that were filled one by one differ where nothing was measured, and the
 * theta_h wavelets pay for it (7 % of a record).
 */
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "spectral.h"
#include "model/math/fill.h"
#include "spectral_kernels.h"

enum {
	SWEEPS = 4, /* rows end where measurements do: what is filled is seldom seen (VARIANTS.md) */
	PIECE = 8,
};

/* A piece of a row with invalid cells: a whole number of PIECEs long, but for the row's end. */
struct run {
	uint32_t at, count, filled; /* filled: the piece where its marks begin */
	int32_t neighbour[4];       /* how far away the same piece is in the rows around; mirrored at the table's ends */
	int8_t first, last;         /* whether the row begins or ends here */
};

struct runs {
	struct run *run;
	float (*filled)[PIECE]; /* 1 where a cell is to be filled, 0 where not */
	uint32_t count, filled_count;
};

/* Adds a run that begins at `column` of a row, nothing in it yet. */
static bool run_begin(struct lattice_dims d, uint32_t row, uint32_t column, struct runs *runs)
{
	const uint32_t i = row / d.theta_d, j = row % d.theta_d;
	const int32_t p = (int32_t)d.phi_d, slice = (int32_t)(d.theta_d * d.phi_d);
	struct run *list = memory_grown(runs->run, runs->count, sizeof *list);

	if (!list)
		return false;
	runs->run = list;
	list[runs->count++] = (struct run){
		.at = row * d.phi_d + column,
		.filled = runs->filled_count,
		.first = column == 0,
		.neighbour = {j ? -p : p, j + 1 < d.theta_d ? p : -p, i ? -slice : slice, i + 1 < d.theta_h ? slice : -slice},
	};
	return true;
}

/* One piece more of the last run. */
static bool run_extend(const uint8_t *valid, uint32_t length, bool last, struct runs *runs)
{
	float(*list)[PIECE] = memory_grown(runs->filled, runs->filled_count, sizeof *list), *marks;

	if (!list)
		return false;
	runs->filled = list;
	marks = list[runs->filled_count++];
	for (uint32_t q = 0; q < length; q++)
		marks[q] = valid[q] ? 0 : 1;
	runs->run[runs->count - 1].count += length;
	runs->run[runs->count - 1].last = last;
	return true;
}

/* All of the table, in order; and present[row]: no cell is invalid. */
static bp_status runs_make(struct lattice_dims d, const uint8_t *valid, uint8_t *present, struct runs *out, bp_error *error)
{
	const uint32_t p = d.phi_d, rows = d.theta_h * d.theta_d;

	for (uint32_t r = 0; r < rows; r++) {
		const uint8_t *row = valid + (size_t)r * p;
		bool before = false; /* the last piece is of a run */
		present[r] = !memchr(row, 0, p);
		for (uint32_t k = 0; k < p && !present[r]; k += PIECE) {
			const uint32_t length = k + PIECE < p ? PIECE : p - k;
			const bool here = memchr(row + k, 0, length) != NULL;
			if ((here && !before && !run_begin(d, r, k, out)) || (here && !run_extend(row + k, length, k + length == p, out)))
				return error_memory(error, out->filled_count * sizeof *out->filled);
			before = here;
		}
	}
	return BP_OK;
}

/* One sweep over the runs, forwards or backwards; mirrored at the table's ends. */
static void sweep(const struct runs *runs, int backwards, float *table)
{
	const struct spectral_kernels *kernels = spectral_kernels_get();

	for (uint32_t n = 0; n < runs->count; n++) {
		const struct run *run = &runs->run[backwards ? runs->count - 1 - n : n];
		float *x = table + run->at;
		const float *const neighbour[4] = {x + run->neighbour[0], x + run->neighbour[1], x + run->neighbour[2],
		                                   x + run->neighbour[3]};
		kernels->spectral_smooth(x, runs->filled[run->filled], neighbour, run->count, run->first ? x[0] : x[-1],
		                         run->last ? x[run->count - 1] : x[run->count]);
	}
}

/* What a slice before the first one with a valid cell is filled with: the mean of that one's; it has to be ready. */
static float start_value(size_t slice, const uint8_t *valid, const float *table)
{
	double sum = 0;
	size_t count = 0;

	for (size_t n = 0; n < slice; n++)
		if (valid[n]) {
			sum += (double)table[n];
			count++;
		}
	return count ? (float)(sum / (double)count) : 0;
}

bp_status spectral_fill(struct lattice_dims d, const uint8_t *valid, float *const table[3], spectral_ready_fn *ready, void *user,
                        bp_error *error)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d, slice = (size_t)d.theta_d * d.phi_d;
	const uint8_t *any = memchr(valid, 1, rows * d.phi_d);
	const size_t first = any ? (size_t)(any - valid) / slice : 0;
	uint8_t *present = malloc(rows);
	struct runs runs = {0};
	struct fill *fill = NULL;
	bp_status status = present ? fill_create(d.theta_d, d.phi_d, &fill, error) : error_memory(error, rows);

	if (!status)
		status = runs_make(d, valid, present, &runs, error);
	for (int c = 0; !status && c < 3; c++) {
		if (ready)
			ready(user, c, (first + 1) * slice);
		float empty = start_value(slice, valid + first * slice, table[c] + first * slice);
		for (size_t i = 0; i < d.theta_h; i++) {
			if (ready)
				ready(user, c, (i + 1) * slice);
			if (memchr(present + i * d.theta_d, 0, d.theta_d))
				fill_plane(fill, table[c] + i * slice, valid + i * slice, empty);
			empty = table[c][i * slice]; /* a slice without a valid cell is flat */
		}
		for (int s = 0; s < SWEEPS; s++)
			sweep(&runs, s % 2, table[c]);
	}
	free(fill);
	free(runs.run);
	free(runs.filled);
	free(present);
	return status;
}
