#include "log_tensor.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"

enum { NONE = 0xFFFFFFFF };

/* Fills the NONE entries of a line of `count` entries `stride` apart: from the nearest before, else from the nearest after. */
static void fill_line(uint32_t *entry, size_t count, size_t stride)
{
	for (int backwards = 0; backwards < 2; backwards++) {
		uint32_t last = NONE;
		for (size_t n = 0; n < count; n++) {
			uint32_t *at = &entry[(backwards ? count - 1 - n : n) * stride];
			last = *at != NONE ? *at : last;
			*at = last;
		}
	}
}

bp_status lattice_fill_sources(const struct lattice *lattice, uint32_t *source, bp_error *error)
{
	const struct lattice_dims dims = lattice->dims;
	const size_t cells = lattice_cells(dims), row = dims.phi_d, slice = row * dims.theta_d;

	for (size_t cell = 0; cell < cells; cell++)
		source[cell] = lattice->valid[cell] ? (uint32_t)cell : NONE;
	for (size_t i = 0; i < dims.theta_h; i++)
		for (size_t k = 0; k < dims.phi_d; k++)
			fill_line(source + i * slice + k, dims.theta_d, row);
	/* a column is now whole or empty, so is a slice after this */
	for (size_t n = 0; n < (size_t)dims.theta_h * dims.theta_d; n++)
		fill_line(source + n * row, dims.phi_d, 1);
	for (size_t n = 0; n < slice; n++)
		fill_line(source + n, dims.theta_h, slice);
	if (source[0] == NONE)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "no valid cell");
	return BP_OK;
}

bp_status log_tensor_make(const struct lattice *lattice, struct log_tensor *out, bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims);
	uint32_t *source = malloc(cells * sizeof *source);
	float *values = malloc(3 * cells * sizeof *values);
	bp_status status;

	if (!source || !values) {
		status = error_memory(error, cells * (sizeof *source + 3 * sizeof *values));
		goto out;
	}
	if ((status = lattice_fill_sources(lattice, source, error)))
		goto out;
	*out = (struct log_tensor){.dims = lattice->dims};
	for (size_t c = 0; c < 3; c++) {
		out->plane[c] = values + c * cells;
		for (size_t cell = 0; cell < cells; cell++)
			if (source[cell] == cell)
				out->plane[c][cell] = (float)log(lattice->rgb[c][cell] + LOG_OFFSET);
		for (size_t cell = 0; cell < cells; cell++)
			out->plane[c][cell] = out->plane[c][source[cell]];
	}
	values = NULL;
out:
	free(source);
	free(values);
	return status;
}

void log_tensor_free(struct log_tensor *tensor)
{
	if (tensor)
		free(tensor->plane[0]);
}

float log_tensor_value(float x) { return fmaxf(0, expf(fminf(50, fmaxf(-50, x))) - (float)LOG_OFFSET); }
