#include "fidelity.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "fidelity_kernels.h"

/* Adds the valid cells of slice i of all tables to their totals; `hidden` are those of them that cannot be seen. */
static void slice_add(const struct lattice *truth, const struct expansion *tables, uint32_t count, uint32_t i,
                      const uint8_t *hidden, const float *cosine, struct fidelity_sums *total)
{
	const size_t slice = (size_t)truth->dims.theta_d * truth->dims.phi_d, at = i * slice;
	struct fidelity_sums sums[LAYERS_MAX];
	struct fidelity_table table[LAYERS_MAX];

	for (uint32_t t = 0; t < count; t++)
		sums[t] = (struct fidelity_sums){.largest_relative = total[t].largest_relative};
	for (int c = 0; c < 3; c++) {
		for (uint32_t t = 0; t < count; t++)
			table[t] = (struct fidelity_table){tables[t].rgb[c] + at, tables[t].unit, &sums[t]};
		fidelity_kernels_get()->fidelity_slice(truth->rgb[c] + at, truth->valid + at, hidden + at, cosine, slice, table, count);
	}
	for (uint32_t t = 0; t < count; t++) {
		total[t].log_squares += sums[t].log_squares;
		total[t].hidden_log_squares += sums[t].hidden_log_squares;
		total[t].cube_root_squares += sums[t].cube_root_squares;
		total[t].largest_relative = sums[t].largest_relative;
	}
}

bp_status fidelity_measure(const struct lattice *truth, const struct expansion *tables, uint32_t count, struct fidelity *out,
                           bp_error *error)
{
	const struct lattice_dims dims = truth->dims;
	struct fidelity_sums total[LAYERS_MAX] = {{0}};
	size_t unseen_count = 0;

	if (count > LAYERS_MAX)
		return error_argument(error, "fidelity: %u tables; %d at most", count, LAYERS_MAX);
	for (uint32_t t = 0; t < count; t++)
		if (!lattice_dims_equal(dims, tables[t].dims))
			return error_argument(error, "fidelity: the two tables have different extents");
	if (!truth->valid_count)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "fidelity: no valid cell to compare");
	const size_t slice = (size_t)dims.theta_d * dims.phi_d, cells = lattice_cells(dims);
	float *cosine = malloc(slice * sizeof *cosine);
	uint8_t *unseen = malloc(cells);
	const bp_status status = cosine && unseen ? BP_OK : error_memory(error, cells + slice * sizeof *cosine);
	if (status)
		goto out;
	lattice_seen(dims, unseen);
	for (size_t n = 0; n < cells; n++)
		unseen_count += unseen[n] = truth->valid[n] & !unseen[n];
	for (uint32_t i = 0; i < dims.theta_h; i++) {
		lattice_corner_cosines(dims, i, cosine);
		slice_add(truth, tables, count, i, unseen, cosine, total);
	}
	const double n = 3.0 * (double)truth->valid_count, n_seen = 3.0 * (double)(truth->valid_count - unseen_count);
	const double log10_of_2 = 0.30102999566398120;
	for (uint32_t t = 0; t < count; t++) {
		out[t].log_rmse = log10_of_2 * sqrt(total[t].log_squares / n);
		out[t].seen_log_rmse = n_seen > 0
		                           ? log10_of_2 * sqrt(fmax(total[t].log_squares - total[t].hidden_log_squares, 0) / n_seen)
		                           : out[t].log_rmse;
		out[t].cube_root_rmse = sqrt(total[t].cube_root_squares / n);
		out[t].largest_relative = total[t].largest_relative < DBL_MAX ? total[t].largest_relative : DBL_MAX;
	}
out:
	free(cosine);
	free(unseen);
	return status;
}
