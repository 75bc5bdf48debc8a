/* test_density.c: conditional pair copulas and error profiles on small lattices. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "render/density.h"

static const struct lattice_dims SMALL = {4, 4, 4};

/* f(d, phi | h) in slice 1 is row[d] * column[phi], times 2 in cell (2, 3) when `dependent`. */
static void lattice_make(bool dependent, struct lattice *lattice)
{
	static const double ROW[4] = {1, 2, 4, 1}, COLUMN[4] = {1, 0.5, 3, 1};
	bp_error error;
	assert_int_equal(lattice_alloc(SMALL, lattice, &error), BP_OK);
	for (uint32_t j = 0; j < 4; j++)
		for (uint32_t k = 0; k < 4; k++)
			for (int c = 0; c < 3; c++)
				lattice->rgb[c][lattice_index(SMALL, 1, j, k)] = ROW[j] * COLUMN[k] * (dependent && j == 2 && k == 3 ? 2 : 1);
	lattice_validate(lattice);
}

/* Density of slice 1, and its mean deviation from 1. The lattice is done with then. */
static double slice_density(struct lattice *lattice, float density[16])
{
	struct density_source source;
	assert_int_equal(density_source_measured(lattice, &source, NULL), BP_OK);
	const double deviation = density_slice(&source, 1, density);
	density_source_free(&source);
	lattice_free(lattice);
	return deviation;
}

static void a_product_of_marginals_has_density_1(void **state)
{
	(void)state;
	struct lattice lattice;
	float density[16];
	lattice_make(false, &lattice);
	assert_true(slice_density(&lattice, density) < 1e-6);
	for (int n = 0; n < 16; n++)
		assert_true(fabs((double)density[n] - 1) < 1e-6);
}

/*
 * Row sums 5.5, 11, 26, 5.5, column sums 8, 4, 24, 12, total 48. c(2, 3) = 8 48 / (26 12) = 1.230769,
 * c(0, 0) = 1 48 / (5.5 8) = 1.090909, c(2, 0) = 4 48 / (26 8) = 0.923077.
 */
static void without_gaps_the_density_is_the_ratio_to_the_marginals(void **state)
{
	(void)state;
	struct lattice lattice;
	float density[16];
	lattice_make(true, &lattice);
	assert_true(slice_density(&lattice, density) > 0.05);
	assert_true(fabs((double)density[2 * 4 + 3] - 1.230769) < 1e-5);
	assert_true(fabs((double)density[0] - 1.090909) < 1e-5);
	assert_true(fabs((double)density[2 * 4] - 0.923077) < 1e-5);
}

/* Plain marginals of what is left would see dependence where there is none. */
static void gaps_do_not_make_independent_angles_look_dependent(void **state)
{
	(void)state;
	struct lattice lattice;
	float density[16];
	lattice_make(false, &lattice);
	lattice.rgb[1][lattice_index(SMALL, 1, 3, 2)] = -1;
	lattice.rgb[1][lattice_index(SMALL, 1, 3, 3)] = -1;
	lattice.rgb[1][lattice_index(SMALL, 1, 2, 2)] = -1;
	lattice_validate(&lattice);
	assert_true(slice_density(&lattice, density) < 1e-4);
	for (int n = 0; n < 16; n++) {
		bool gap = n == 14 || n == 15 || n == 10;
		assert_true(gap ? isnan(density[n]) : fabs((double)density[n] - 1) < 1e-4);
	}
}

static void an_empty_slice_and_a_black_one_are_harmless(void **state)
{
	(void)state;
	bp_error error;
	struct expansion table;
	struct density_source source;
	uint8_t valid[64] = {0};
	float density[16];
	for (int n = 16; n < 64; n++)
		valid[n] = 1;
	assert_int_equal(expansion_alloc(SMALL, &table, &error), BP_OK);
	table.unit = 1;
	for (int c = 0; c < 3; c++)
		for (int n = 0; n < 64; n++)
			table.rgb[c][n] = 0;
	assert_int_equal(density_source_decoded(&table, valid, &source, &error), BP_OK);
	assert_true(density_slice(&source, 0, density) == 0 && isnan(density[5]));
	assert_true(density_slice(&source, 1, density) == 0 && density[5] == 1);
	density_source_free(&source);
	expansion_free(&table);
}

/* Slice 1 measured 1, decoded 2 in R and 0.5 in G: (1 + 0.5 + 0)/3; one cell of 16 invalid and far off. */
static void error_profiles_are_means_over_valid_cells(void **state)
{
	(void)state;
	bp_error error;
	struct lattice lattice;
	struct expansion table;
	double profile[4];
	assert_int_equal(lattice_alloc(SMALL, &lattice, &error), BP_OK);
	assert_int_equal(expansion_alloc(SMALL, &table, &error), BP_OK);
	table.unit = 0.5;
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < 64; n++) {
			lattice.rgb[c][n] = 1;
			table.rgb[c][n] = c == 0 ? 4 : c == 1 ? 1 : 2;
		}
	for (size_t n = 48; n < 64; n++)
		lattice.rgb[0][n] = -1;
	lattice.rgb[2][20] = -1;
	table.rgb[2][20] = 1e6f;
	lattice_validate(&lattice);
	error_profile(&lattice, &table, profile);
	assert_true(fabs(profile[1] - 0.5) < 1e-12 && fabs(profile[0] - 0.5) < 1e-12 && isnan(profile[3]));

	/* 0.25 + 0.5 * 1 = 0.75; max(0, -2 + 1) = 0; 1: errors 0.25, 1, 0 */
	const struct colour_fit colour[3] = {{.diffuse = 0.25, .specular = 0.5}, {.diffuse = -2, .specular = 1}, {.specular = 1}};
	error_profile_uncoded(&lattice, colour, profile);
	assert_true(fabs(profile[1] - 1.25 / 3) < 1e-12 && isnan(profile[3]));
	expansion_free(&table);
	lattice_free(&lattice);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_product_of_marginals_has_density_1),
		cmocka_unit_test(without_gaps_the_density_is_the_ratio_to_the_marginals),
		cmocka_unit_test(gaps_do_not_make_independent_angles_look_dependent),
		cmocka_unit_test(an_empty_slice_and_a_black_one_are_harmless),
		cmocka_unit_test(error_profiles_are_means_over_valid_cells),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
