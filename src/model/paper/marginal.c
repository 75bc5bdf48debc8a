#include "marginal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "paper_kernels.h"

static bp_status means_alloc(struct means *means, size_t n, bp_error *error)
{
	means->value = calloc(n, sizeof *means->value);
	means->valid = calloc(n, sizeof *means->valid);
	means->count = calloc(n, sizeof *means->count);
	return means->value && means->valid && means->count ? BP_OK : error_memory(error, n * sizeof *means->value);
}

static void means_free(struct means *means)
{
	free(means->value);
	free(means->valid);
	free(means->count);
}

void density_free(struct density *density)
{
	free(density->value);
	for (int axis = 0; axis < 3; axis++)
		means_free(&density->axis[axis]);
	means_free(&density->hd);
	means_free(&density->hphi);
	memset(density, 0, sizeof *density);
}

/* Sums of factor (r + g + b) into all means, in a fixed order: rows, then slices. Returns the sum over the lattice. */
static double sums_gather(const struct lattice *lattice, double factor, struct density *out)
{
	const struct paper_kernels *kernels = paper_kernels_get();
	const struct lattice_dims d = lattice->dims;
	double total = 0;

	for (uint32_t i = 0; i < d.theta_h; i++) {
		double *slice_column = out->hphi.value + (size_t)i * d.phi_d, slice = 0;
		uint32_t *slice_count = out->hphi.count + (size_t)i * d.phi_d, slice_cells = 0;

		for (uint32_t j = 0; j < d.theta_d; j++) {
			const size_t at = lattice_index(d, i, j, 0), pair = (size_t)i * d.theta_d + j;
			const double *const rgb[3] = {lattice->rgb[0] + at, lattice->rgb[1] + at, lattice->rgb[2] + at};
			uint32_t count;
			double sum = kernels->density_row(rgb, lattice->valid + at, d.phi_d, factor, out->value + at, slice_column,
			                                  slice_count, &count);
			out->hd.value[pair] = sum;
			out->hd.count[pair] = count;
			out->axis[1].value[j] += sum;
			out->axis[1].count[j] += count;
			slice += sum;
			slice_cells += count;
		}
		for (uint32_t k = 0; k < d.phi_d; k++) {
			out->axis[2].value[k] += slice_column[k];
			out->axis[2].count[k] += slice_count[k];
		}
		out->axis[0].value[i] = slice;
		out->axis[0].count[i] = slice_cells;
		total += slice;
	}
	return total;
}

static double largest_value(const struct lattice *lattice)
{
	double largest = 0;

	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < lattice_cells(lattice->dims); i++)
			if (lattice->valid[i] && lattice->rgb[c][i] > largest)
				largest = lattice->rgb[c][i];
	return largest;
}

static void sums_clear(struct density *out)
{
	const struct lattice_dims d = out->dims;
	const uint32_t extents[3] = {d.theta_h, d.theta_d, d.phi_d};

	for (int axis = 0; axis < 3; axis++) {
		memset(out->axis[axis].value, 0, extents[axis] * sizeof(double));
		memset(out->axis[axis].count, 0, extents[axis] * sizeof(uint32_t));
	}
	memset(out->hphi.value, 0, (size_t)d.theta_h * d.phi_d * sizeof(double));
	memset(out->hphi.count, 0, (size_t)d.theta_h * d.phi_d * sizeof(uint32_t));
}

/*
 * The mean being 1. Where a whole row is as dark as that, its copulas are ratios of next to nothing: digits that the same table in
 * another unit has lost, or 0 / 0 where it says 0.
 */
static double dark_removed(double v)
{
	return v < DENSITY_DARK ? 0 : v;
}

static void means_finish(struct means *means, size_t n, double factor)
{
	for (size_t i = 0; i < n; i++) {
		means->valid[i] = means->count[i] != 0;
		means->value[i] = means->count[i] ? dark_removed(means->value[i] * factor / means->count[i]) : 0;
	}
}

bp_status density_build(const struct lattice *lattice, struct density *out, bp_error *error)
{
	const struct lattice_dims d = lattice->dims;
	const size_t cells = lattice_cells(d), nd = d.theta_d, np = d.phi_d, nh = d.theta_h;
	int exponent = 0; /* the sums are of 2^exponent (r + g + b) */

	*out = (struct density){.dims = d, .valid = lattice->valid};
	if (!lattice->valid_count)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "no valid cell");
	out->value = malloc(cells * sizeof *out->value);
	bp_status status = out->value ? BP_OK : error_memory(error, cells * sizeof *out->value);
	status = status ? status : means_alloc(&out->axis[0], nh, error);
	status = status ? status : means_alloc(&out->axis[1], nd, error);
	status = status ? status : means_alloc(&out->axis[2], np, error);
	status = status ? status : means_alloc(&out->hd, nh * nd, error);
	status = status ? status : means_alloc(&out->hphi, nh * np, error);
	if (status) {
		density_free(out);
		return status;
	}
	double total = sums_gather(lattice, 1, out);
	if (total != 0 && !(total > 1e-250 && total < 1e300)) { /* seldom: near the ends of double's range */
		frexp(largest_value(lattice), &exponent);
		exponent = exponent < -1000 ? 1000 : -exponent;
		sums_clear(out);
		total = sums_gather(lattice, ldexp(1, exponent), out);
	}
	const double mean = total / (double)lattice->valid_count;
	const double inverse = mean > 0 ? 1 / mean : 0;
	out->mean = ldexp(mean / 3, -exponent);
	means_finish(&out->axis[0], nh, inverse);
	means_finish(&out->axis[1], nd, inverse);
	means_finish(&out->axis[2], np, inverse);
	means_finish(&out->hd, nh * nd, inverse);
	means_finish(&out->hphi, nh * np, inverse);
	for (size_t i = 0; i < cells; i++)
		out->value[i] = dark_removed(out->value[i] * inverse);
	return BP_OK;
}
