#include "fidelity.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "../error.h"
#include "kernels.h"

bp_status fidelity_measure(const struct lattice *truth, const struct expansion *table, struct fidelity *out, bp_error *error)
{
	const struct lattice_dims dims = truth->dims;
	const size_t slice = (size_t)dims.theta_d * dims.phi_d, cells = lattice_cells(dims);
	const struct kernels *kernels = kernels_get();
	struct fidelity_sums total = {0, 0, 0};

	if (dims.theta_h != table->dims.theta_h || dims.theta_d != table->dims.theta_d || dims.phi_d != table->dims.phi_d)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "fidelity: the two tables have different extents");
	if (!truth->valid_count)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "fidelity: no valid cell to compare");
	float *cosine = malloc(cells * sizeof *cosine);
	if (!cosine)
		return error_memory(error, cells * sizeof *cosine);
	bp_status status = lattice_corner_cosine(dims, cosine, error);
	if (status)
		goto out;
	for (uint32_t i = 0; i < dims.theta_h; i++) {
		struct fidelity_sums sums = {0, 0, 0};
		const size_t at = i * slice;

		for (int c = 0; c < 3; c++)
			kernels->fidelity_slice(truth->rgb[c] + at, table->rgb[c] + at, truth->valid + at, cosine + at, slice, table->unit,
			                        &sums);
		total.log_squares += sums.log_squares;
		total.cube_root_squares += sums.cube_root_squares;
		if (sums.largest_relative > total.largest_relative)
			total.largest_relative = sums.largest_relative;
	}
	const double n = 3.0 * (double)truth->valid_count;
	const double log10_of_2 = 0.30102999566398120;
	out->log_rmse = log10_of_2 * sqrt(total.log_squares / n);
	out->cube_root_rmse = sqrt(total.cube_root_squares / n);
	out->largest_relative = total.largest_relative < DBL_MAX ? total.largest_relative : DBL_MAX;
out:
	free(cosine);
	return status;
}
