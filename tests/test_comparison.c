/* test_comparison.c: the figures of one material together, and the pictures made of it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "render/comparison.h"
#include "render/figure.h"
#include "scratch.h"

static const struct lattice_dims SMALL = {6, 5, 8};

static void tables_make(double factor, struct lattice *lattice, struct expansion *table)
{
	bp_error error;
	assert_int_equal(lattice_alloc(SMALL, lattice, &error), BP_OK);
	assert_int_equal(expansion_alloc(SMALL, table, &error), BP_OK);
	table->unit = 0.25;
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < lattice_cells(SMALL); n++) {
			lattice->rgb[c][n] = n % 7 ? 0.25 : -1;
			table->rgb[c][n] = (float)factor;
		}
	lattice_validate(lattice);
}

/* Everything 10 % too bright where valid: e = 0.275 for b = 0.25. */
static void a_uniform_error_shows_in_every_figure_as_expected(void **state)
{
	(void)state;
	bp_error error;
	struct lattice lattice;
	struct expansion table;
	struct comparison_plans plans = {.lightings = lightings_of(LIGHTING_COUNT), .size = 12};
	struct comparison comparison;
	struct picture pictures[LIGHTING_COUNT] = {{0}};
	tables_make(1.1, &lattice, &table);
	assert_int_equal(comparison_measure(&plans, &lattice, &table, &comparison, pictures, &error), BP_OK);
	assert_true(fabs(comparison.fidelity.log_rmse - log10(0.276 / 0.251)) < 1e-6);
	assert_true(fabs(comparison.worst.value - 0.025 / 0.26) < 1e-6);
	assert_true(fabs(comparison.worst.value - comparison.fidelity.largest_relative) < 1e-12);
	assert_true(fabs(comparison.decoded.largest - 1.1 * comparison.measured.largest) < 1e-6);
	for (int l = 0; l < LIGHTING_COUNT; l++) {
		/* at the 90th percentile sRGB(0.99) - sRGB(0.9) = 0.0410: 27.7 dB; darker pixels differ less, brighter ones are cut */
		assert_true(comparison.psnr[l].real > 27.7 && comparison.psnr[l].real < 40);
		assert_true(fabs(comparison.psnr[l].eight_bit - comparison.psnr[l].real) < 1);
		/* grey, 10 % brighter: 720 (q(99) - q(90)) = 6.86 there; less in darker pixels, and in brighter ones, which are cut */
		assert_true(comparison.itp[l] > 3 && comparison.itp[l] < 6.9);
		assert_int_equal(pictures[l].width, 36);
		picture_free(&pictures[l]);
	}
	comparison_plans_free(&plans);
	lattice_free(&lattice);
	expansion_free(&table);
}

static void equal_tables_reach_the_caps(void **state)
{
	(void)state;
	bp_error error;
	struct lattice lattice;
	struct expansion table;
	struct comparison_plans plans = {.lightings = 1u << LIGHTING_KEY, .size = 8};
	struct comparison comparison;
	tables_make(1, &lattice, &table);
	assert_int_equal(comparison_measure(&plans, &lattice, &table, &comparison, NULL, &error), BP_OK);
	assert_true(comparison.psnr[LIGHTING_KEY].real > 119.9 && comparison.psnr[LIGHTING_ENV].real == 0);
	assert_true(comparison.itp[LIGHTING_KEY] == 0);
	assert_true(comparison.fidelity.log_rmse == 0 && comparison.worst.value == 0);
	comparison_plans_free(&plans);
	lattice_free(&lattice);
	expansion_free(&table);
}

static void other_extents_and_an_invalid_reference_are_refused(void **state)
{
	(void)state;
	bp_error error;
	struct lattice lattice;
	struct expansion table, other;
	struct comparison_plans plans = {.lightings = 1u << LIGHTING_KEY, .size = 8};
	struct comparison comparison;
	tables_make(1, &lattice, &table);
	assert_int_equal(expansion_alloc((struct lattice_dims){4, 5, 8}, &other, &error), BP_OK);
	assert_int_equal(comparison_measure(&plans, &lattice, &other, &comparison, NULL, &error), BP_ERROR_BAD_INPUT);
	assert_non_null(strstr(error.message, "6 x 5 x 8"));
	assert_non_null(strstr(error.message, "4 x 5 x 8"));
	for (size_t n = 0; n < lattice_cells(SMALL); n++)
		lattice.rgb[0][n] = -1;
	lattice_validate(&lattice);
	assert_int_equal(comparison_measure(&plans, &lattice, &table, &comparison, NULL, &error), BP_ERROR_BAD_INPUT);
	comparison_plans_free(&plans);
	expansion_free(&other);
	lattice_free(&lattice);
	expansion_free(&table);
}

static void the_figure_is_written_as_svg_and_as_png(void **state)
{
	(void)state;
	bp_error error;
	struct lattice lattice;
	struct expansion table;
	struct density_source source;
	double profile[6];
	char path[SCRATCH_BYTES], start[256];
	tables_make(1.1, &lattice, &table);
	assert_int_equal(scratch_file(path), 0);
	assert_int_equal(density_source_measured(&lattice, &source, &error), BP_OK);
	error_profile(&lattice, &table, profile);
	struct figure figure = {.title = "a <small> lattice",
	                        .dims = SMALL,
	                        .error_after = profile,
	                        .row_count = 1,
	                        .slice_count = 2,
	                        .rows = {{"measured", &source}},
	                        .slices = {1, 5}};
	for (int svg = 0; svg < 2; svg++) {
		assert_int_equal(figure_write(path, svg, &figure, &error), BP_OK);
		FILE *file = fopen(path, "rb");
		assert_int_equal(fread(start, 1, sizeof start, file), sizeof start);
		fclose(file);
		assert_memory_equal(start, svg ? "<svg" : "\x89PNG", 4);
	}
	unlink(path);
	density_source_free(&source);
	lattice_free(&lattice);
	expansion_free(&table);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_uniform_error_shows_in_every_figure_as_expected),
		cmocka_unit_test(equal_tables_reach_the_caps),
		cmocka_unit_test(other_extents_and_an_invalid_reference_are_refused),
		cmocka_unit_test(the_figure_is_written_as_svg_and_as_png),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
