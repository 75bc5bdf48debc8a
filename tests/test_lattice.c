/*
 * Lattice geometry and validity. The oracle computes directions by rotating vectors with libm,
 * as the coordinates are defined, and shares no formula with lattice.c.
 */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "merl/lattice.h"

/* The smaller of cos theta_i and cos theta_o: wi about the pole h, tilted by theta_h in the xz plane; wo is its reflection at h. */
static double smaller_cosine(double theta_h, double theta_d, double phi_d)
{
	const double x = sin(theta_d) * cos(phi_d), z = cos(theta_d);
	const double in = -sin(theta_h) * x + cos(theta_h) * z;
	const double out = 2 * z * cos(theta_h) - in; /* wo = 2 (wi.h) h - wi */
	return fmin(in, out);
}

static double theta_h_of(struct lattice_dims dims, double i) { return i * i / dims.theta_h / dims.theta_h * M_PI_2; }
static double theta_d_of(struct lattice_dims dims, double j) { return j / dims.theta_d * M_PI_2; }
static double phi_d_of(struct lattice_dims dims, double k) { return k / dims.phi_d * M_PI; }

static double at(struct lattice_dims dims, double i, double j, double k)
{
	return smaller_cosine(theta_h_of(dims, i), theta_d_of(dims, j), phi_d_of(dims, k));
}

static void dims_are_legal_from_4_to_1024_and_up_to_the_cell_limit(void **state)
{
	(void)state;
	assert_true(lattice_dims_legal(LATTICE_MERL));
	assert_true(lattice_dims_legal((struct lattice_dims){4, 4, 4}));
	assert_true(lattice_dims_legal((struct lattice_dims){1024, 1024, 16}));
	assert_false(lattice_dims_legal((struct lattice_dims){1024, 1024, 17}));
	assert_false(lattice_dims_legal((struct lattice_dims){3, 90, 180}));
	assert_false(lattice_dims_legal((struct lattice_dims){90, 1025, 4}));
	assert_false(lattice_dims_legal((struct lattice_dims){90, 90, UINT32_MAX}));
	assert_int_equal(lattice_cells(LATTICE_MERL), 1458000);
	assert_int_equal(lattice_index(LATTICE_MERL, 89, 89, 179), 1457999);
}

static void illegal_dims_are_refused_and_leave_the_output_alone(void **state)
{
	(void)state;
	bp_error error;
	struct lattice lattice;
	struct expansion expansion;
	memset(&lattice, 7, sizeof lattice);
	memset(&expansion, 7, sizeof expansion);
	const struct lattice lattice_before = lattice;
	assert_int_equal(lattice_alloc((struct lattice_dims){0, 90, 180}, &lattice, &error), BP_ERROR_LIMIT);
	assert_int_equal(expansion_alloc((struct lattice_dims){90, 90, 100000}, &expansion, &error), BP_ERROR_LIMIT);
	assert_memory_equal(&lattice, &lattice_before, sizeof lattice);
}

static void planes_are_aligned_and_apart_and_nothing_is_valid(void **state)
{
	(void)state;
	const struct lattice_dims dims = {5, 7, 11};
	const size_t cells = lattice_cells(dims);
	struct lattice lattice;
	assert_int_equal(lattice_alloc(dims, &lattice, NULL), BP_OK);
	for (int c = 0; c < 3; c++) {
		assert_int_equal((uintptr_t)lattice.rgb[c] % 64, 0);
		for (size_t n = 0; n < cells; n++)
			lattice.rgb[c][n] = c + 1;
	}
	for (size_t n = 0; n < cells; n++)
		assert_int_equal(lattice.valid[n], 0);
	memset(lattice.valid, 1, cells);
	for (int c = 0; c < 3; c++)
		assert_true(lattice.rgb[c][0] == c + 1 && lattice.rgb[c][cells - 1] == c + 1);
	lattice_free(&lattice);
	assert_null(lattice.rgb[0]);
	lattice_free(&lattice);
	expansion_free(&(struct expansion){0});
}

static void a_cell_is_valid_when_all_channels_are_finite_and_not_negative(void **state)
{
	(void)state;
	static const struct {
		double r, g, b;
		int valid, nonfinite;
	} cases[] = {
		{0, 0, 0, 1, 0},           {-0.0, 1, 1, 1, 0},     {1e300, 1e-300, DBL_MIN / 4, 1, 0},
		{DBL_MAX, 1, 1, 1, 0},     {-1e-300, 1, 1, 0, 0},  {1, -1, 1, 0, 0},
		{1, 1, -1, 0, 0},          {-1, -1, -1, 0, 0},     {NAN, 1, 1, 0, 1},
		{1, -NAN, 1, 0, 1},        {1, 1, INFINITY, 0, 1}, {-INFINITY, 1, 1, 0, 1},
		{NAN, -1, INFINITY, 0, 1},
	};
	const size_t count = sizeof cases / sizeof *cases;
	struct lattice lattice;
	assert_int_equal(lattice_alloc((struct lattice_dims){9, 8, 7}, &lattice, NULL), BP_OK);
	const size_t cells = lattice_cells(lattice.dims);
	size_t valid = 0, nonfinite = 0;
	for (size_t n = 0; n < cells; n++) {
		lattice.rgb[0][n] = cases[n % count].r;
		lattice.rgb[1][n] = cases[n % count].g;
		lattice.rgb[2][n] = cases[n % count].b;
		valid += (size_t)cases[n % count].valid;
		nonfinite += (size_t)cases[n % count].nonfinite;
	}
	lattice_validate(&lattice);
	assert_int_equal(lattice.valid_count, valid);
	assert_int_equal(lattice.nonfinite_count, nonfinite);
	for (size_t n = 0; n < cells; n++) {
		assert_int_equal(lattice.valid[n], cases[n % count].valid);
		for (int c = 0; c < 3; c++)
			assert_true(isfinite(lattice.rgb[c][n]) && !signbit(lattice.rgb[c][n]));
		if (lattice.valid[n])
			assert_true(lattice.rgb[0][n] == cases[n % count].r && lattice.rgb[1][n] == cases[n % count].g);
	}
	assert_true(lattice.most == DBL_MAX);
	lattice_free(&lattice);
}

static void no_valid_value_is_above_the_most(void **state)
{
	(void)state;
	static const double top[3] = {7, -7, INFINITY}; /* of a valid cell, and of two that are not */
	for (int t = 0; t < 3; t++) {
		struct lattice lattice;
		assert_int_equal(lattice_alloc((struct lattice_dims){7, 8, 9}, &lattice, NULL), BP_OK);
		const size_t cells = lattice_cells(lattice.dims), at = cells - 2;
		for (size_t n = 0; n < cells; n++)
			for (int c = 0; c < 3; c++)
				lattice.rgb[c][n] = n == at && c == 1 ? top[t] : (double)(n % 3);
		lattice_validate(&lattice);
		assert_int_equal(lattice.valid[at], t == 0);
		assert_true(lattice.most == (t == 0 ? 7 : 2));
		lattice_free(&lattice);
	}
}

static void quarter_turns_agree_with_libm_and_are_exact_at_the_ends(void **state)
{
	(void)state;
	double cosine, sine;
	quarter_cos_sin(0, &cosine, &sine);
	assert_true(cosine == 1 && sine == 0);
	quarter_cos_sin(1, &cosine, &sine);
	assert_true(cosine == 0 && sine == 1);
	for (int n = 0; n <= 10000; n++) {
		quarter_cos_sin(n / 1e4, &cosine, &sine);
		assert_true(fabs(cosine - cos(n / 1e4 * M_PI_2)) < 3e-16 && fabs(sine - sin(n / 1e4 * M_PI_2)) < 3e-16);
	}
}

static void the_corner_cosine_agrees_with_rotated_directions(void **state)
{
	(void)state;
	const struct lattice_dims all[] = {{90, 90, 180}, {4, 4, 4}, {7, 5, 9}};
	for (size_t d = 0; d < sizeof all / sizeof *all; d++) {
		const struct lattice_dims dims = all[d];
		float *cosine = malloc((size_t)dims.theta_d * dims.phi_d * sizeof *cosine);
		for (uint32_t i = 0; i < dims.theta_h; i += 3) {
			lattice_corner_cosines(dims, i, cosine);
			for (uint32_t j = 0; j < dims.theta_d; j += 2)
				for (uint32_t k = 0; k < dims.phi_d; k++) {
					const double expected = fmax(0, at(dims, i, j, k));
					assert_true(fabs((double)cosine[lattice_index(dims, 0, j, k)] - expected) < 1e-7);
				}
		}
		free(cosine);
	}
}

/* Whether any of a fine grid of points inside the cell is above the horizon. */
static int touches_above(struct lattice_dims dims, uint32_t i, uint32_t j, uint32_t k)
{
	for (int a = 0; a <= 4; a++)
		for (int b = 0; b <= 4; b++)
			for (int c = 0; c <= 4; c++)
				if (at(dims, i + a / 4.0, j + b / 4.0, k + c / 4.0) > 1e-12)
					return 1;
	return 0;
}

static void below_the_horizon_means_the_whole_cell_and_its_centre_under_the_limit(void **state)
{
	(void)state;
	const struct lattice_dims all[] = {{24, 18, 20}, {4, 4, 4}, {7, 5, 9}};
	const double limits[] = {0, -0.03, -0.0610485, -0.0871557};
	for (size_t d = 0; d < sizeof all / sizeof *all; d++)
		for (size_t l = 0; l < sizeof limits / sizeof *limits; l++) {
			const struct lattice_dims dims = all[d];
			uint8_t *below = malloc(lattice_cells(dims));
			lattice_below_horizon(dims, limits[l], below);
			for (uint32_t i = 0; i < dims.theta_h; i++)
				for (uint32_t j = 0; j < dims.theta_d; j++)
					for (uint32_t k = 0; k < dims.phi_d; k++)
						assert_int_equal(below[lattice_index(dims, i, j, k)],
						                 at(dims, i + 0.5, j + 0.5, k + 0.5) < limits[l] && !touches_above(dims, i, j, k));
			free(below);
		}
}

static void merl_has_its_share_of_cells_below_the_horizon(void **state)
{
	(void)state;
	/* The database: 305,826 cells (20.98 %) are invalid; they lie symmetric in phi_d. */
	uint8_t *below = malloc(lattice_cells(LATTICE_MERL));
	lattice_below_horizon(LATTICE_MERL, LATTICE_MERL_HORIZON, below);
	size_t count = 0;
	for (uint32_t i = 0; i < 90; i++)
		for (uint32_t j = 0; j < 90; j++)
			for (uint32_t k = 0; k < 180; k++) {
				count += below[lattice_index(LATTICE_MERL, i, j, k)];
				assert_int_equal(below[lattice_index(LATTICE_MERL, i, j, k)], below[lattice_index(LATTICE_MERL, i, j, 179 - k)]);
			}
	assert_int_equal(count, 305826);
	free(below);
}

static void the_limit_of_a_material_gives_back_the_pattern_it_was_measured_with(void **state)
{
	(void)state;
	const struct lattice_dims all[] = {{90, 90, 180}, {16, 16, 16}, {33, 20, 41}};
	const double degrees[] = {0.5, 2, 3.5, 4.9};
	for (size_t d = 0; d < sizeof all / sizeof *all; d++)
		for (size_t g = 0; g < sizeof degrees / sizeof *degrees; g++) {
			struct lattice lattice;
			assert_int_equal(lattice_alloc(all[d], &lattice, NULL), BP_OK);
			const size_t cells = lattice_cells(all[d]);
			uint8_t *measured = malloc(cells), *below = malloc(cells);
			lattice_below_horizon(all[d], -sin(degrees[g] / 180 * M_PI), measured);
			for (size_t n = 0; n < cells; n++)
				lattice.valid[n] = !measured[n];
			const double limit = lattice_horizon_limit(&lattice);
			assert_true(limit <= 0 && limit >= -0.0872);
			assert_true((double)(float)limit == limit);
			lattice_below_horizon(all[d], limit, below);
			assert_memory_equal(measured, below, cells);
			lattice_free(&lattice);
			free(measured);
			free(below);
		}
}

static void the_limit_stays_between_0_and_5_degrees_whatever_is_valid(void **state)
{
	(void)state;
	struct lattice lattice;
	assert_int_equal(lattice_alloc((struct lattice_dims){20, 20, 20}, &lattice, NULL), BP_OK);
	assert_true(lattice_horizon_limit(&lattice) == 0);
	lattice.valid[0] = 1;
	assert_true(lattice_horizon_limit(&lattice) == 0);
	memset(lattice.valid, 1, lattice_cells(lattice.dims));
	assert_true(fabs(lattice_horizon_limit(&lattice) + sin(5.0 / 180 * M_PI)) < 1e-7);
	lattice_free(&lattice);
}

static void the_largest_is_that_of_the_valid_cells(void **unused)
{
	(void)unused;
	struct lattice l;
	assert_int_equal(lattice_alloc((struct lattice_dims){4, 5, 6}, &l, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < 120; i++)
			l.rgb[c][i] = (double)(i * 37 % 120) * (c == 1 ? 3 : 1);
	for (size_t i = 0; i < 120; i++)
		l.valid[i] = 0;
	assert_true(lattice_largest(&l) == 0);
	l.valid[7] = l.valid[90] = 1;
	l.rgb[2][90] = 1e9;
	l.rgb[0][91] = 1e12; /* not valid */
	assert_true(lattice_largest(&l) == 1e9);
	l.valid[90] = 0;
	assert_true(lattice_largest(&l) == l.rgb[1][7]);
	lattice_free(&l);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(dims_are_legal_from_4_to_1024_and_up_to_the_cell_limit),
		cmocka_unit_test(illegal_dims_are_refused_and_leave_the_output_alone),
		cmocka_unit_test(the_largest_is_that_of_the_valid_cells),
		cmocka_unit_test(planes_are_aligned_and_apart_and_nothing_is_valid),
		cmocka_unit_test(a_cell_is_valid_when_all_channels_are_finite_and_not_negative),
		cmocka_unit_test(no_valid_value_is_above_the_most),
		cmocka_unit_test(quarter_turns_agree_with_libm_and_are_exact_at_the_ends),
		cmocka_unit_test(the_corner_cosine_agrees_with_rotated_directions),
		cmocka_unit_test(below_the_horizon_means_the_whole_cell_and_its_centre_under_the_limit),
		cmocka_unit_test(merl_has_its_share_of_cells_below_the_horizon),
		cmocka_unit_test(the_limit_of_a_material_gives_back_the_pattern_it_was_measured_with),
		cmocka_unit_test(the_limit_stays_between_0_and_5_degrees_whatever_is_valid),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
