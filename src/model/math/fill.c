#include "fill.h"

#include <stdlib.h>

#include "error.h"
#include "fill_kernels.h"

enum { LEVELS_MAX = 24, SWEEPS = 4 };

struct fill {
	struct fill_level level[LEVELS_MAX]; /* level 0 is the caller's plane; each halves the one before, down to a single cell */
	float *row;                          /* two rows of scratch, a cell longer on both sides */
	float values[]; /* of levels 1.., one after the other; behind them the rows, and which values are valid */
};

bp_status fill_create(uint32_t rows, uint32_t columns, struct fill **out, bp_error *error)
{
	const size_t scratch = 2 * ((size_t)columns + 2);
	size_t cells = 0, at = 0;

	for (uint32_t r = rows, c = columns; r > 1 || c > 1; cells += (size_t)r * c) {
		r = (r + 1) / 2;
		c = (c + 1) / 2;
	}
	const size_t bytes = sizeof(struct fill) + (cells + scratch) * sizeof(float) + cells;
	struct fill *fill = malloc(bytes);
	if (!fill)
		return error_memory(error, bytes);
	fill->row = fill->values + cells;
	uint8_t *const valid = (uint8_t *)(fill->row + scratch);
	fill->level[0] = (struct fill_level){.rows = rows, .columns = columns};
	for (unsigned l = 1; at < cells; l++) {
		const struct fill_level *below = &fill->level[l - 1];
		fill->level[l] = (struct fill_level){(below->rows + 1) / 2, (below->columns + 1) / 2, fill->values + at, valid + at};
		at += (size_t)fill->level[l].rows * fill->level[l].columns;
	}
	*out = fill;
	return BP_OK;
}

void fill_plane(struct fill *fill, float *plane, const uint8_t *valid, float when_empty)
{
	const struct fill_kernels *kernels = fill_kernels_get();
	const size_t cells = (size_t)fill->level[0].rows * fill->level[0].columns;
	size_t count = 0;
	unsigned top = 0;

	for (size_t i = 0; i < cells; i++)
		count += valid[i] != 0;
	if (count == cells)
		return;
	if (!count) {
		for (size_t i = 0; i < cells; i++)
			plane[i] = when_empty;
		return;
	}
	fill->level[0].value = plane;
	fill->level[0].valid = (uint8_t *)(uintptr_t)valid; /* level 0's is only read */
	/* Up, until nothing is left to fill: at the latest at the single cell on top. */
	while (kernels->fill_halve(&fill->level[top], &fill->level[top + 1]))
		top++;
	/* And down again; the level above is complete. */
	for (unsigned l = top + 1; l-- > 0;) {
		kernels->fill_interpolate(&fill->level[l + 1], &fill->level[l], fill->row);
		kernels->fill_smooth(&fill->level[l], SWEEPS, fill->row);
	}
}
