#include "density.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"

enum { ROUNDS_MAX = 500 };

static bp_status source_alloc(struct lattice_dims dims, const uint8_t *valid, struct density_source *out, bp_error *error)
{
	*out = (struct density_source){.dims = dims, .mean = calloc(lattice_cells(dims), sizeof(float)), .valid = valid};
	return out->mean ? BP_OK : error_memory(error, lattice_cells(dims) * sizeof(float));
}

bp_status density_source_measured(const struct lattice *lattice, struct density_source *out, bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims);
	const bp_status status = source_alloc(lattice->dims, lattice->valid, out, error);
	if (status)
		return status;
	double largest = 0;
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < cells; n++)
			largest = lattice->valid[n] ? fmax(largest, lattice->rgb[c][n]) : largest;
	/* copulas do not depend on the scale: any magnitude fits a float */
	double scale = largest > 0 ? 1 / (3 * largest) : 1;
	for (size_t n = 0; n < cells; n++)
		if (lattice->valid[n])
			out->mean[n] = (float)(lattice->rgb[0][n] * scale + lattice->rgb[1][n] * scale + lattice->rgb[2][n] * scale);
	return BP_OK;
}

bp_status density_source_decoded(const struct expansion *table, const uint8_t *valid, struct density_source *out, bp_error *error)
{
	const bp_status status = source_alloc(table->dims, valid, out, error);
	for (size_t n = 0; !status && n < lattice_cells(table->dims); n++)
		if (valid[n])
			out->mean[n] = (table->rgb[0][n] + table->rgb[1][n] + table->rgb[2][n]) / 3;
	return status;
}

void density_source_free(struct density_source *source)
{
	free(source->mean);
	*source = (struct density_source){0};
}

struct factors {
	uint32_t rows, columns;
	double row[LATTICE_EXTENT_MAX], column[LATTICE_EXTENT_MAX];
	double row_sum[LATTICE_EXTENT_MAX], column_sum[LATTICE_EXTENT_MAX];
};

/* One round: rows from columns, then columns from rows; the largest relative change of a row. */
static double factors_round(struct factors *factors, const uint8_t *valid)
{
	double change = 0, under[LATTICE_EXTENT_MAX] = {0};
	for (uint32_t j = 0; j < factors->rows; j++) {
		double sum = 0, before = factors->row[j];
		for (uint32_t k = 0; k < factors->columns; k++)
			sum += valid[k + factors->columns * j] ? factors->column[k] : 0;
		factors->row[j] = sum > 0 ? factors->row_sum[j] / sum : 0;
		change = fmax(change, fabs(factors->row[j] - before) / fmax(before, 1e-300));
		for (uint32_t k = 0; k < factors->columns; k++)
			under[k] += valid[k + factors->columns * j] ? factors->row[j] : 0;
	}
	for (uint32_t k = 0; k < factors->columns; k++)
		factors->column[k] = under[k] > 0 ? factors->column_sum[k] / under[k] : 0;
	return change;
}

double density_slice(const struct density_source *source, uint32_t i, float *density)
{
	struct factors factors = {.rows = source->dims.theta_d, .columns = source->dims.phi_d};
	const size_t first = lattice_index(source->dims, i, 0, 0), cells = (size_t)factors.rows * factors.columns;
	const float *f = source->mean + first;
	const uint8_t *valid = source->valid + first;
	double weight = 0, squares = 0;

	for (size_t n = 0; n < cells; n++)
		if (valid[n]) {
			factors.row_sum[n / factors.columns] += (double)f[n];
			factors.column_sum[n % factors.columns] += (double)f[n];
		}
	for (uint32_t k = 0; k < factors.columns; k++)
		factors.column[k] = 1;
	for (int round = 0; round < ROUNDS_MAX && factors_round(&factors, valid) > 1e-6; round++)
		;
	for (size_t n = 0; n < cells; n++) {
		double product = factors.row[n / factors.columns] * factors.column[n % factors.columns];
		density[n] = !valid[n] ? NAN : product > 0 ? (float)((double)f[n] / product) : 1;
		if (valid[n] && product > 0 && f[n] > 0) {
			double bits = log2((double)f[n] / product);
			squares += product * bits * bits;
			weight += product;
		}
	}
	return weight > 0 ? sqrt(squares / weight) : 0;
}

/* What stands for channel c of a cell, in 1/sr. */
typedef double estimate_fn(const void *from, const struct lattice *truth, int c, size_t n);

static double table_estimate(const void *from, const struct lattice *truth, int c, size_t n)
{
	const struct expansion *table = from;
	(void)truth;
	return table->unit * (double)table->rgb[c][n];
}

static double regression_estimate(const void *from, const struct lattice *truth, int c, size_t n)
{
	const struct colour_fit *fit = (const struct colour_fit *)from + c;
	return fmax(0, fit->diffuse + fit->specular * ((truth->rgb[0][n] + truth->rgb[1][n] + truth->rgb[2][n]) / 3));
}

static void profile_take(const struct lattice *truth, estimate_fn *estimate, const void *from, double *error_mean)
{
	const size_t slice = (size_t)truth->dims.theta_d * truth->dims.phi_d;
	for (uint32_t i = 0; i < truth->dims.theta_h; i++) {
		double sum = 0, count = 0;
		for (size_t n = i * slice; n < (i + 1) * slice; n++)
			for (int c = 0; c < 3 && truth->valid[n]; c++, count++)
				sum += fabs(estimate(from, truth, c, n) - truth->rgb[c][n]);
		error_mean[i] = count > 0 ? sum / count : NAN;
	}
}

void error_profile(const struct lattice *truth, const struct expansion *table, double *error_mean)
{
	profile_take(truth, table_estimate, table, error_mean);
}

void error_profile_uncoded(const struct lattice *truth, const struct colour_fit colour[3], double *error_mean)
{
	profile_take(truth, regression_estimate, colour, error_mean);
}
