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

enum { SWEEPS = 20 };

bp_status default_fill(struct lattice_dims d, const uint8_t *valid, float *table, bp_error *error)
{
	const struct kernels *kernels = kernels_get();
	const size_t p = d.phi_d, rows = (size_t)d.theta_h * d.theta_d, slice = d.theta_d * p;
	uint8_t *present = malloc(rows); /* 0: the row has an invalid cell */
	float *scratch = malloc((p + 2) * sizeof *scratch);
	struct fill *fill = NULL;
	bp_status status = BP_OK;
	float empty = 0;

	if (!present || !scratch) {
		status = error_memory(error, rows);
		goto out;
	}
	for (size_t r = 0; r < rows; r++)
		present[r] = !memchr(valid + r * p, 0, p);
	status = fill_create(d.theta_d, d.phi_d, false, false, &fill, error);
	if (status)
		goto out;
	for (size_t i = 0; i < d.theta_h; i++) {
		if (memchr(present + i * d.theta_d, 0, d.theta_d))
			fill_plane(fill, table + i * slice, valid + i * slice, empty);
		empty = table[i * slice]; /* a slice without a valid cell is flat */
	}
	for (unsigned s = 0; s < SWEEPS; s++)
		for (size_t q = 0; q < rows; q++) {
			const size_t r = s % 2 ? rows - 1 - q : q, i = r / d.theta_d, j = r % d.theta_d;
			float *row = table + r * p;
			if (present[r])
				continue;
			const float *const neighbour[4] = {
				j ? row - p : row + p,
				j + 1 < d.theta_d ? row + p : row - p,
				i ? row - slice : row + slice,
				i + 1 < d.theta_h ? row + slice : row - slice,
			};
			kernels->default_smooth(row, valid + r * p, neighbour, p, scratch);
		}
out:
	fill_free(fill);
	free(present);
	free(scratch);
	return status;
}
