#include "two_halves.h"

#include <stdlib.h>

#include "error.h"

enum { ROW = 180, HEADER_BYTES = 12 };

bool two_halves_extents(const int32_t extent[3]) { return extent[0] == 90 && extent[1] == 90 && extent[2] == 2 * ROW; }

uint64_t two_halves_bytes(void) { return HEADER_BYTES + 2 * 3 * sizeof(double) * (uint64_t)lattice_cells(LATTICE_MERL); }

/* Rows of 360 values, of which each half takes 180. */
static bp_status planes_split(struct input *in, struct lattice half[2], bp_error *error)
{
	const size_t rows = lattice_cells(LATTICE_MERL) / ROW;
	for (int c = 0; c < 3; c++)
		for (size_t row = 0; row < rows; row++)
			for (int h = 0; h < 2; h++) {
				double *values = half[h].rgb[c] + row * ROW;
				size_t got;
				bp_status status = input_fill(in, values, ROW * sizeof *values, &got, error);
				if (status != BP_OK)
					return status;
				if (got < ROW * sizeof *values)
					return input_truncated(two_halves_bytes(), in->done, error);
				lattice_scan(values, ROW, MERL_SCALE[c], half[h].valid + row * ROW);
			}
	return input_end(in, error);
}

static double mean(const struct lattice *lattice, size_t cell)
{
	return (lattice->rgb[0][cell] + lattice->rgb[1][cell] + lattice->rgb[2][cell]) / 3;
}

/* The mean goes into `a`. What is wrong with either half, as lattice_scan noted it, is wrong with the cell. */
static void halves_join(struct lattice *a, const struct lattice *b, struct reciprocity *reciprocity)
{
	const size_t cells = lattice_cells(a->dims);
	for (size_t n = 0; n < cells; n++)
		a->valid[n] |= b->valid[n];
	lattice_scan_finish(a);
	for (size_t n = 0; n < cells; n++) {
		if (a->valid[n])
			reciprocity_add(reciprocity, mean(a, n), mean(b, n));
		for (int c = 0; c < 3; c++)
			a->rgb[c][n] = a->valid[n] ? 0.5 * (a->rgb[c][n] + b->rgb[c][n]) : 0;
	}
}

bp_status two_halves_read(struct input *in, struct lattice *out, struct origin *origin, bp_error *error)
{
	struct lattice half[2] = {{.block = NULL}, {.block = NULL}};
	struct reciprocity *reciprocity = calloc(1, sizeof *reciprocity);
	bp_status status = reciprocity ? BP_OK : error_memory(error, sizeof *reciprocity);
	for (int h = 0; h < 2 && !status; h++)
		status = lattice_alloc(LATTICE_MERL, &half[h], error);
	if (!status)
		status = planes_split(in, half, error);
	if (!status) {
		halves_join(&half[0], &half[1], reciprocity);
		*origin = (struct origin){.kind = ORIGIN_TWO_HALVES};
		reciprocity_tell(reciprocity, origin);
		if (origin->median > TWO_HALVES_MEDIAN_MAX || origin->percentile95 > TWO_HALVES_PERCENTILE95_MAX)
			status =
				error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
			              "360 cells of phi_d, and the two halves disagree: relative difference %.3f in the median, %.3f in the "
			              "95th percentile; up to %g and %g are taken for one reciprocal material",
			              origin->median, origin->percentile95, TWO_HALVES_MEDIAN_MAX, TWO_HALVES_PERCENTILE95_MAX);
	}
	free(reciprocity);
	lattice_free(&half[1]);
	if (status)
		lattice_free(&half[0]);
	else
		*out = half[0];
	return status;
}
