#include "lookup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"

static size_t table_row(struct lattice_dims dims, uint32_t j, uint32_t i)
{
	return 4 * (size_t)(dims.phi_d + 1) * (i + (size_t)(dims.theta_h + 1) * j);
}

/* Repeats the first cell after the end of each row, the last row after each slice, the last slice at the end. */
static void table_wrap(struct lookup_table *table)
{
	struct lattice_dims dims = table->dims;
	size_t row = 4 * (size_t)(dims.phi_d + 1), slice = row * (dims.theta_h + 1);
	for (uint32_t j = 0; j < dims.theta_d; j++) {
		for (uint32_t i = 0; i < dims.theta_h; i++) {
			float *cells = table->cells + table_row(dims, j, i);
			memcpy(cells + row - 4, cells, 4 * sizeof(float));
		}
		float *end = table->cells + table_row(dims, j, dims.theta_h);
		memcpy(end, end - row, row * sizeof(float));
	}
	float *end = table->cells + table_row(dims, dims.theta_d, 0);
	memcpy(end, end - slice, slice * sizeof(float));
}

/* See lookup_table_measured. */
static double table_unit(const struct lattice *lattice)
{
	double largest = 0;
	size_t cells = lattice_cells(lattice->dims);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < cells; n++)
			if (lattice->valid[n] && lattice->rgb[c][n] > largest)
				largest = lattice->rgb[c][n];
	return largest > 0 && (largest < 1e-20 || largest > 1e20) ? largest : 1;
}

/* Of planes of doubles, which are divided by the unit, or of floats, which are multiplied by `scale`. */
static bp_status table_make(struct lattice_dims dims, double *const measured[3], float *const decoded[3], double scale,
                            const uint8_t *valid, double unit, struct lookup_table *out, bp_error *error)
{
	size_t bytes = (size_t)(dims.theta_d + 1) * (dims.theta_h + 1) * (dims.phi_d + 1) * 4 * sizeof(float);
	bytes = (bytes + 63) / 64 * 64;
	struct lookup_table table = {.dims = dims, .unit = unit, .cells = aligned_alloc(64, bytes)};
	if (!table.cells)
		return error_memory(error, bytes);
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++) {
			size_t from = lattice_index(dims, i, j, 0);
			float *to = table.cells + table_row(dims, j, i);
			for (uint32_t k = 0; k < dims.phi_d; k++, from++, to += 4) {
				for (int c = 0; c < 3; c++)
					to[c] = (float)(!valid[from] ? 0 : measured ? measured[c][from] / unit : (double)decoded[c][from] * scale);
				to[3] = 0;
			}
		}
	table_wrap(&table);
	*out = table;
	return BP_OK;
}

bp_status lookup_table_measured(const struct lattice *lattice, struct lookup_table *out, bp_error *error)
{
	return table_make(lattice->dims, lattice->rgb, NULL, 1, lattice->valid, table_unit(lattice), out, error);
}

bp_status lookup_table_decoded(const struct expansion *expansion, const uint8_t *valid, double unit, struct lookup_table *out,
                               bp_error *error)
{
	unit = unit > 0 ? unit : expansion->unit;
	return table_make(expansion->dims, NULL, expansion->rgb, expansion->unit / unit, valid, unit, out, error);
}

void lookup_table_free(struct lookup_table *table)
{
	free(table->cells);
	*table = (struct lookup_table){0};
}

enum { ANGLE_STEPS = 8192 };
struct angle_tables {
	double root_theta[ANGLE_STEPS + 2]; /* sqrt(theta/(pi/2)) over sqrt(sin(theta/2)) in [0, sqrt(sin 45 deg)] */
	double theta[ANGLE_STEPS + 2];      /* theta/(pi/2) over sin(theta/2) in [0, sin 45 deg] */
	double atan[ANGLE_STEPS + 2];       /* atan(x)/pi over x in [0, 1] */
};

struct angle_tables *angle_tables_make(void)
{
	struct angle_tables *angles = malloc(sizeof *angles);
	if (!angles)
		return NULL;
	for (int i = 0; i < ANGLE_STEPS + 2; i++) {
		double x = (double)i / ANGLE_STEPS;
		angles->root_theta[i] = sqrt(asin(fmin(1, x * x * M_SQRT1_2)) / M_PI_4);
		angles->theta[i] = asin(fmin(1, x * M_SQRT1_2)) / M_PI_4;
		angles->atan[i] = atan(x) / M_PI;
	}
	return angles;
}

/* fmin and fmax are calls, for the sake of NaN; there is none here. */
static double lesser(double a, double b) { return a < b ? a : b; }

static double greater(double a, double b) { return a > b ? a : b; }

static double table_at(const double *table, double x)
{
	double at = lesser(x, 1) * ANGLE_STEPS;
	int i = (int)at;
	return table[i] + (at - i) * (table[i + 1] - table[i]);
}

/* atan2(y, x)/pi folded to [0, 1): phi_d and phi_d + pi are the same direction pair. */
static double fold_phi(const struct angle_tables *angles, double y, double x)
{
	double ay = fabs(y), ax = fabs(x), large = greater(ax, ay);
	if (large <= 0)
		return 0;
	double turn = table_at(angles->atan, lesser(ax, ay) / large);
	if (ay > ax)
		turn = 0.5 - turn;
	return (y < 0) != (x < 0) && turn > 0 ? 1 - turn : turn;
}

/* Cell and fraction of a place `at` in [0, extent], counted from the first centre; beyond the last cell stands its copy. */
static uint32_t split(double at, uint32_t extent, uint16_t *fraction)
{
	uint32_t cell = at < extent ? (uint32_t)at : extent - 1;
	*fraction = (uint16_t)(lesser(1, at - cell) * 65535 + 0.5);
	return cell;
}

struct place place_make(const struct angle_tables *angles, struct lattice_dims dims, double cos_theta_h, double cos_theta_d,
                        double y, double x, double gain)
{
	/* sin(theta/2) keeps its precision near 0, where the cosine has none */
	double half_h = sqrt(greater(0, 1 - cos_theta_h) * 0.5), half_d = sqrt(greater(0, 1 - cos_theta_d) * 0.5);
	double at_h = table_at(angles->root_theta, sqrt(half_h * M_SQRT2)) * dims.theta_h - 0.5;
	double at_d = table_at(angles->theta, half_d * M_SQRT2) * dims.theta_d - 0.5;
	double at_phi = fold_phi(angles, y, x) * dims.phi_d - 0.5;
	struct place place = {.gain = (float)gain};
	uint32_t i = split(greater(0, at_h), dims.theta_h, &place.theta_h);
	uint32_t j = split(greater(0, at_d), dims.theta_d, &place.theta_d);
	uint32_t k = split(at_phi < 0 ? at_phi + dims.phi_d : at_phi, dims.phi_d, &place.phi_d);
	place.cell = k + (dims.phi_d + 1) * (i + (dims.theta_h + 1) * j);
	return place;
}
