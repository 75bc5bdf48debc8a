#include "fill.h"

#include <stdlib.h>

#include "error.h"
#include "fill_kernels.h"

enum { LEVELS_MAX = 24, SWEEPS = 4 };

struct fill {
	unsigned levels; /* level 0 is the caller's plane */
	struct fill_level level[LEVELS_MAX];
	float *values; /* of levels 1.., one after the other */
	uint8_t *valid;
	float *row; /* two rows of scratch, a cell longer on both sides */
};

bp_status fill_create(uint32_t rows, uint32_t columns, struct fill **out, bp_error *error)
{
	struct fill *fill = calloc(1, sizeof *fill);
	size_t cells = 0;

	if (!fill)
		return error_memory(error, sizeof *fill);
	for (uint32_t r = rows, c = columns;; r = (r + 1) / 2, c = (c + 1) / 2) {
		fill->level[fill->levels].rows = r;
		fill->level[fill->levels].columns = c;
		cells += fill->levels ? (size_t)r * c : 0;
		fill->levels++;
		if (r == 1 && c == 1)
			break;
	}
	fill->values = malloc((cells + 1) * sizeof *fill->values);
	fill->valid = malloc(cells + 1);
	fill->row = malloc(2 * ((size_t)columns + 2) * sizeof *fill->row);
	if (!fill->values || !fill->valid || !fill->row) {
		fill_free(fill);
		return error_memory(error, cells * 5);
	}
	size_t at = 0;
	for (unsigned l = 1; l < fill->levels; l++) {
		fill->level[l].value = fill->values + at;
		fill->level[l].valid = fill->valid + at;
		at += (size_t)fill->level[l].rows * fill->level[l].columns;
	}
	*out = fill;
	return BP_OK;
}

void fill_free(struct fill *fill)
{
	if (!fill)
		return;
	free(fill->values);
	free(fill->valid);
	free(fill->row);
	free(fill);
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
