#include "density.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"

enum { ROUNDS_MAX = 500 };

static bp_status source_alloc(struct lattice_dims dims, struct density_source *out, bp_error *error)
{
	size_t cells = lattice_cells(dims);
	struct density_source source = {.dims = dims, .mean = calloc(cells, sizeof(float)), .valid = malloc(cells)};
	if (!source.mean || !source.valid) {
		density_source_free(&source);
		return error_memory(error, 5 * cells);
	}
	*out = source;
	return BP_OK;
}

bp_status density_source_measured(const struct lattice *lattice, struct density_source *out, bp_error *error)
{
	size_t cells = lattice_cells(lattice->dims);
	struct density_source source;
	bp_status status = source_alloc(lattice->dims, &source, error);
	if (status != BP_OK)
		return status;
	double largest = 0;
	for (size_t n = 0; n < cells; n++)
		if ((source.valid[n] = lattice->valid[n]))
			for (int c = 0; c < 3; c++)
				largest = fmax(largest, lattice->rgb[c][n]);
	/* copulas do not depend on the scale: any magnitude fits a float */
	double scale = largest > 0 ? 1 / (3 * largest) : 1;
	for (size_t n = 0; n < cells; n++)
		if (source.valid[n])
			source.mean[n] = (float)(lattice->rgb[0][n] * scale + lattice->rgb[1][n] * scale + lattice->rgb[2][n] * scale);
	*out = source;
	return BP_OK;
}

bp_status density_source_decoded(const struct expansion *table, const uint8_t *valid, struct density_source *out, bp_error *error)
{
	size_t cells = lattice_cells(table->dims);
	struct density_source source;
	bp_status status = source_alloc(table->dims, &source, error);
	if (status != BP_OK)
		return status;
	for (size_t n = 0; n < cells; n++)
		if ((source.valid[n] = valid ? valid[n] : 1))
			source.mean[n] = (table->rgb[0][n] + table->rgb[1][n] + table->rgb[2][n]) / 3;
	*out = source;
	return BP_OK;
}

void density_source_free(struct density_source *source)
{
	free(source->mean);
	free(source->valid);
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

void error_profile(const struct lattice *truth, const struct expansion *table, double *error_mean)
{
	size_t slice = (size_t)truth->dims.theta_d * truth->dims.phi_d;
	for (uint32_t i = 0; i < truth->dims.theta_h; i++) {
		double sum = 0, count = 0;
		for (size_t n = i * slice; n < (i + 1) * slice; n++)
			if (truth->valid[n]) {
				for (int c = 0; c < 3; c++)
					sum += fabs(table->unit * (double)table->rgb[c][n] - truth->rgb[c][n]);
				count += 3;
			}
		error_mean[i] = count > 0 ? sum / count : NAN;
	}
}

void error_profile_uncoded(const struct lattice *truth, const struct colour_fit colour[3], double *error_mean)
{
	size_t slice = (size_t)truth->dims.theta_d * truth->dims.phi_d;
	for (uint32_t i = 0; i < truth->dims.theta_h; i++) {
		double sum = 0, count = 0;
		for (size_t n = i * slice; n < (i + 1) * slice; n++)
			if (truth->valid[n]) {
				double mean = (truth->rgb[0][n] + truth->rgb[1][n] + truth->rgb[2][n]) / 3;
				for (int c = 0; c < 3; c++)
					sum += fabs(fmax(0, colour[c].diffuse + colour[c].specular * mean) - truth->rgb[c][n]);
				count += 3;
			}
		error_mean[i] = count > 0 ? sum / count : NAN;
	}
}
