/*
 * Holes that a table does not mark: which habits are recognised, on which lattices, and what stays measured.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "merl/demo.h"
#include "merl/holes.h"

static const struct lattice_dims LATTICES[] = {{90, 90, 180}, {16, 16, 16}, {33, 20, 41}, {8, 12, 10}};
enum { LATTICE_COUNT = sizeof LATTICES / sizeof *LATTICES };

/* What a program may do to a value in 1/sr of a channel. */
typedef double habit_fn(double value, int channel);

static double clamped(double value, int channel) { return channel >= 0 && value > 0 ? value : 0; }
static double raised(double value, int channel) { return channel >= 0 && value > 1e-9 ? value : 1e-9; }
static double raised_as_stored(double value, int channel)
{
	return fmax(value / MERL_SCALE[channel], 1e-9) * MERL_SCALE[channel];
}
static double absolute(double value, int channel) { return channel >= 0 ? fabs(value) : 0; }
static double stretched(double value, int channel) { return channel >= 0 ? (value + MERL_SCALE[2]) / (1e3 + MERL_SCALE[2]) : 0; }
static double not_a_number(double value, int channel) { return channel >= 0 && value >= 0 ? value : NAN; }
static double kept_in_red(double value, int channel) { return channel == 0 || value > 0 ? value : 0; }

/* A demo material without faults, as a program writes it back that has this habit; valid is that of the original. */
static void written_back(struct lattice_dims dims, size_t material, habit_fn *habit, struct lattice *out, uint8_t **valid)
{
	const size_t cells = lattice_cells(dims);
	assert_int_equal(demo_generate(material, dims, true, out, NULL), BP_OK);
	*valid = malloc(cells);
	memcpy(*valid, out->valid, cells);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < cells; n++)
			out->rgb[c][n] = habit(out->valid[n] ? out->rgb[c][n] : -MERL_SCALE[c], c);
	lattice_validate(out);
}

static void every_habit_is_recognised_on_every_lattice(void **state)
{
	static const struct {
		habit_fn *habit;
		bool marks; /* the table still says itself what was measured */
	} habits[] = {{clamped, false},   {raised, false},      {raised_as_stored, false}, {absolute, false},
	              {stretched, false}, {not_a_number, true}, {kept_in_red, true}};
	(void)state;
	for (size_t d = 0; d < LATTICE_COUNT; d++)
		for (size_t h = 0; h < sizeof habits / sizeof *habits; h++) {
			struct lattice lattice;
			struct holes holes;
			uint8_t *valid;
			written_back(LATTICES[d], 4, habits[h].habit, &lattice, &valid);
			const size_t cells = lattice_cells(lattice.dims), before = lattice.valid_count;
			assert_int_equal(lattice_take_holes(&lattice, ZEROS_AUTO, &holes, NULL), BP_OK);
			assert_memory_equal(lattice.valid, valid, cells);
			assert_int_equal(holes.count, habits[h].marks ? 0 : cells - lattice.valid_count);
			assert_int_equal(lattice.valid_count, before - holes.count);
			assert_int_equal(holes.black_count, 0);
			for (int c = 0; c < 3; c++)
				assert_true(holes.value[c] == (habits[h].marks ? 0 : habits[h].habit(-MERL_SCALE[c], c)));
			for (size_t n = 0; n < cells; n++)
				assert_true(lattice.valid[n] || lattice.rgb[1][n] == 0);
			lattice_free(&lattice);
			free(valid);
		}
}

static void measured_means_measured_and_marks_are_enough(void **state)
{
	struct lattice lattice;
	struct holes holes;
	uint8_t *valid;
	(void)state;
	written_back(LATTICES[1], 4, clamped, &lattice, &valid);
	assert_int_equal(lattice_take_holes(&lattice, ZEROS_MEASURED, &holes, NULL), BP_OK);
	assert_true(holes.count == 0 && lattice.valid_count == lattice_cells(lattice.dims));
	lattice.rgb[1][7] = -1; /* one negative value: this table marks what was not measured */
	lattice_validate(&lattice);
	assert_int_equal(lattice_take_holes(&lattice, ZEROS_AUTO, &holes, NULL), BP_OK);
	assert_true(holes.count == 0 && lattice.valid_count == lattice_cells(lattice.dims) - 1);
	lattice_free(&lattice);
	free(valid);
}

/* Sets the cells for which it is asked for, beyond theta_h index `from`, to 0. */
static size_t blacken(struct lattice *lattice, uint32_t from)
{
	const size_t first = lattice_index(lattice->dims, from, 0, 0), cells = lattice_cells(lattice->dims);
	for (int c = 0; c < 3; c++)
		memset(lattice->rgb[c] + first, 0, (cells - first) * sizeof(double));
	return cells - first;
}

static void what_is_black_above_the_horizon_stays_black(void **state)
{
	(void)state;
	for (size_t d = 0; d < LATTICE_COUNT; d++) {
		struct lattice lattice;
		struct holes holes;
		uint8_t *valid;
		written_back(LATTICES[d], 12, clamped, &lattice, &valid);
		const size_t cells = lattice_cells(lattice.dims);
		uint8_t *seen = malloc(cells);
		lattice_seen(lattice.dims, seen);
		blacken(&lattice, lattice.dims.theta_h * 3 / 4);
		size_t black = 0, hidden = 0;
		for (size_t n = 0; n < cells; n++) {
			black += seen[n] && lattice.rgb[0][n] == 0;
			hidden += !seen[n];
		}
		assert_int_equal(lattice_take_holes(&lattice, ZEROS_AUTO, &holes, NULL), BP_OK);
		assert_true(holes.count > 0 && holes.count <= hidden && black > 0);
		assert_int_equal(holes.black_count, black);
		for (size_t n = 0; n < cells; n++)
			assert_true(lattice.valid[n] || !seen[n]);
		/* and are holes where that is asked for */
		assert_int_equal(lattice_take_holes(&lattice, ZEROS_HOLES, &holes, NULL), BP_OK);
		assert_true(holes.black_count == 0 && holes.count >= black);
		for (size_t n = 0; n < cells; n++)
			assert_true(!lattice.valid[n] || lattice.rgb[0][n] > 0);
		lattice_free(&lattice);
		free(valid);
		free(seen);
	}
}

/* Of a black table nobody can tell. */
static void black_and_constant_tables_are_measured(void **state)
{
	static const double values[] = {0, 0.25};
	(void)state;
	for (int v = 0; v < 2; v++) {
		struct lattice lattice;
		struct holes holes;
		assert_int_equal(lattice_alloc(LATTICES[2], &lattice, NULL), BP_OK);
		for (int c = 0; c < 3; c++)
			for (size_t n = 0; n < lattice_cells(lattice.dims); n++)
				lattice.rgb[c][n] = values[v];
		lattice_validate(&lattice);
		assert_int_equal(lattice_take_holes(&lattice, ZEROS_AUTO, &holes, NULL), BP_OK);
		assert_true(holes.count == 0 && lattice.valid_count == lattice_cells(lattice.dims));
		bp_error error;
		assert_int_equal(lattice_take_holes(&lattice, ZEROS_HOLES, &holes, &error), v ? BP_OK : BP_ERROR_BAD_INPUT);
		lattice_free(&lattice);
	}
}

/* floor + lobe(theta_h), defined everywhere: nobody left anything out. */
static void material_fill(struct lattice_dims dims, double floor_value, double width, struct lattice *out)
{
	assert_int_equal(lattice_alloc(dims, out, NULL), BP_OK);
	for (uint32_t i = 0; i < dims.theta_h; i++) {
		const double h = (i + 0.5) / dims.theta_h, x = 90 * h * h / width, lobe = x < 1 ? 1 + 10 * (1 - x) : 0;
		for (size_t n = lattice_index(dims, i, 0, 0); n < lattice_index(dims, i, 0, 0) + (size_t)dims.theta_d * dims.phi_d; n++)
			for (int c = 0; c < 3; c++)
				out->rgb[c][n] = floor_value + lobe;
	}
	lattice_validate(out);
}

static void materials_that_are_defined_everywhere_are_measured(void **state)
{
	static const struct {
		double floor_value, width; /* 1/sr, degrees */
	} materials[] = {{0.1, 2}, {0.1, 20}, {0, 40}, {0, 60}};
	(void)state;
	for (size_t m = 0; m < sizeof materials / sizeof *materials; m++) {
		struct lattice lattice;
		struct holes holes;
		material_fill(LATTICE_MERL, materials[m].floor_value, materials[m].width, &lattice);
		assert_int_equal(lattice_take_holes(&lattice, ZEROS_AUTO, &holes, NULL), BP_OK);
		assert_int_equal(holes.count, 0);
		lattice_free(&lattice);
	}
}

/* A formula that is 0 below the horizon, taken at centres: cells whose centre is below are holes, though a part of them is not. */
static void a_formula_that_ends_at_the_horizon(void **state)
{
	(void)state;
	for (size_t d = 0; d < LATTICE_COUNT; d++) {
		struct lattice lattice;
		struct holes holes;
		material_fill(LATTICES[d], 0.2, 30, &lattice);
		const size_t cells = lattice_cells(lattice.dims);
		uint8_t *below = malloc(cells);
		lattice_centre_below(lattice.dims, 0, below);
		size_t count = 0;
		for (size_t n = 0; n < cells; n++)
			for (int c = 0; c < 3; c++)
				if (below[n]) {
					count += c == 0;
					lattice.rgb[c][n] = 0;
				}
		assert_int_equal(lattice_take_holes(&lattice, ZEROS_AUTO, &holes, NULL), BP_OK);
		assert_int_equal(holes.count, count);
		for (size_t n = 0; n < cells; n++)
			assert_int_equal(lattice.valid[n], !below[n]);
		lattice_free(&lattice);
		free(below);
	}
}

/* Dark readings at the very edge of the database's pattern do not move it. */
static void black_cells_at_the_edge_stay_measured(void **state)
{
	struct lattice lattice;
	struct holes holes;
	uint8_t *valid, *near_edge = malloc(lattice_cells(LATTICE_MERL));
	(void)state;
	written_back(LATTICE_MERL, 9, clamped, &lattice, &valid);
	lattice_centre_below(LATTICE_MERL, LATTICE_MERL_HORIZON + 0.002, near_edge);
	for (size_t n = 0; n < lattice_cells(LATTICE_MERL); n++)
		for (int c = 0; c < 3 && near_edge[n]; c++)
			lattice.rgb[c][n] = 0;
	assert_int_equal(lattice_take_holes(&lattice, ZEROS_AUTO, &holes, NULL), BP_OK);
	assert_int_equal(holes.count, 305826);
	assert_memory_equal(lattice.valid, valid, lattice_cells(LATTICE_MERL));
	lattice_free(&lattice);
	free(valid);
	free(near_edge);
}

/*
 * Deeper below the horizon than an instrument reaches all cells hold one value. Where most of those above it do too, the material has
 * that value there; where few do, the value stands for "not measured".
 */
static void a_value_that_goes_on_above_a_deep_edge_is_measured(void **state)
{
	const struct lattice_dims dims = LATTICES[1];
	const size_t cells = lattice_cells(dims);
	uint8_t *seen = malloc(cells), *deep = malloc(cells);
	(void)state;
	lattice_seen(dims, seen);
	lattice_centre_below(dims, -0.15, deep);
	for (int most = 0; most < 2; most++) {
		struct lattice lattice;
		struct holes holes;
		size_t hidden = 0, shallow = 0;
		assert_int_equal(lattice_alloc(dims, &lattice, NULL), BP_OK);
		for (size_t n = 0; n < cells; n++) {
			const bool same = !seen[n] && (deep[n] || (shallow++ % 4 != 0) == most);
			hidden += !seen[n] && deep[n];
			for (int c = 0; c < 3; c++)
				lattice.rgb[c][n] = same ? 0.25 : 0.5 + 0.001 * (double)(n % 97);
		}
		assert_true(hidden > shallow);
		lattice_validate(&lattice);
		assert_int_equal(lattice_take_holes(&lattice, ZEROS_AUTO, &holes, NULL), BP_OK);
		if (most)
			assert_int_equal(holes.count, 0);
		else
			assert_true(holes.count >= hidden && holes.count <= hidden + shallow / 4 + 1 && holes.value[1] == 0.25);
		lattice_free(&lattice);
	}
	free(seen);
	free(deep);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_habit_is_recognised_on_every_lattice),
		cmocka_unit_test(measured_means_measured_and_marks_are_enough),
		cmocka_unit_test(what_is_black_above_the_horizon_stays_black),
		cmocka_unit_test(black_and_constant_tables_are_measured),
		cmocka_unit_test(materials_that_are_defined_everywhere_are_measured),
		cmocka_unit_test(a_formula_that_ends_at_the_horizon),
		cmocka_unit_test(black_cells_at_the_edge_stay_measured),
		cmocka_unit_test(a_value_that_goes_on_above_a_deep_edge_is_measured),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
