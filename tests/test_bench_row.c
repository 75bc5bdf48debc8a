/*
 * The benchmark's table: medians, order, and what is printed where nothing was measured; and the timed look-ups' directions.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bench/methods.h"
#include "bench/row.h"
#include "bench/timing.h"

static struct row row_of(int material, int method, double budget, double bytes, double ns)
{
	return (struct row){.material = material, .method = method, .budget = budget, .bytes = bytes, .evaluate_ns = ns};
}

static void a_median_is_taken_per_column_and_leaves_out_what_is_absent(void **unused)
{
	const struct row rows[4] = {row_of(0, 0, 0, 30, NAN), row_of(1, 0, 0, 10, 5), row_of(2, 0, 0, 20, NAN),
	                            row_of(3, 0, 0, 40, 7)};
	(void)unused;

	assert_true(row_median(rows, 4).bytes == 25);
	assert_true(row_median(rows, 3).bytes == 20);
	assert_true(row_median(rows, 4).evaluate_ns == 6);
	assert_true(isnan(row_median(rows, 1).evaluate_ns));
}

static void rows_are_ordered_by_method_budget_and_material(void **unused)
{
	struct row rows[4] = {row_of(1, 1, 0, 0, 0), row_of(0, 1, 8000, 1, 0), row_of(1, 0, 8000, 2, 0), row_of(0, 1, 0, 3, 0)};
	(void)unused;

	qsort(rows, 4, sizeof *rows, row_compare);
	assert_true(rows[0].bytes == 2 && rows[1].bytes == 3 && rows[2].bytes == 0 && rows[3].bytes == 1);
}

static void efforts_are_settings_of_their_own(void **unused)
{
	struct row rows[3] = {row_of(0, 1, 60400, 0, 0), row_of(1, 1, 60400, 1, 0), row_of(0, 1, 60400, 2, 0)};
	(void)unused;

	rows[0].effort = rows[1].effort = 9;
	rows[2].effort = 1;
	qsort(rows, 3, sizeof *rows, row_compare);
	assert_true(rows[0].bytes == 2 && rows[1].bytes == 0 && rows[2].bytes == 1);
	assert_false(row_same_setting(&rows[0], &rows[1]));
	assert_true(row_same_setting(&rows[1], &rows[2]));
}

static void methods_are_chosen_by_their_whole_names(void **unused)
{
	bool on[METHOD_COUNT];
	char unknown[16];
	(void)unused;

	assert_true(methods_choose("spectral,cat", on, unknown, sizeof unknown));
	for (int m = 0; m < METHOD_COUNT; m++)
		assert_int_equal(on[m], !strcmp(METHODS[m].name, "spectral") || !strcmp(METHODS[m].name, "cat"));
	assert_false(methods_choose("ward,defaul", on, unknown, sizeof unknown));
	assert_string_equal(unknown, "defaul");
	for (int m = 0; m < METHOD_COUNT; m++)
		assert_int_equal(METHODS[m].baseline == NULL, m >= METHOD_FITS);
}

static void a_line_has_a_field_for_every_column(void **unused)
{
	struct row row = row_of(0, 0, 0, 60400, NAN);
	char *text = NULL, *header;
	size_t size;
	int tabs[2] = {0, 0};
	FILE *out = open_memstream(&text, &size);
	(void)unused;

	assert_non_null(out);
	row_print_header(out);
	row.evaluated = EVALUATED_MODEL;
	row_print(out, "name", "ward", &row);
	fclose(out);
	header = strchr(text, '\n');
	assert_non_null(header);
	for (const char *c = text; *c; c++)
		tabs[c > header] += *c == '\t';
	assert_int_equal(tabs[0], tabs[1]);
	/* no budget, no parameters, no evaluation time */
	assert_non_null(strstr(text, "name\tward\t-\t-\t60400\t-\t0\t0\t-\t"));
	free(text);
}

static void the_directions_are_unit_vectors_above_the_horizon(void **unused)
{
	struct pairs *pairs = malloc(sizeof *pairs);
	double mean = 0;
	(void)unused;

	assert_non_null(pairs);
	pairs_make(pairs);
	for (int n = 0; n < PAIRS; n++)
		for (int side = 0; side < 2; side++) {
			const double *w = side ? pairs->wo[n] : pairs->wi[n];
			assert_true(fabs(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] - 1) < 1e-12);
			assert_true(w[2] > 0.0174);
			mean += w[2] / (2 * PAIRS);
		}
	/* cosine-distributed: the mean cosine is 2/3; its standard error here is 7e-4 */
	assert_true(fabs(mean - 2. / 3) < 4e-3);
	free(pairs);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_median_is_taken_per_column_and_leaves_out_what_is_absent),
		cmocka_unit_test(rows_are_ordered_by_method_budget_and_material),
		cmocka_unit_test(efforts_are_settings_of_their_own),
		cmocka_unit_test(methods_are_chosen_by_their_whole_names),
		cmocka_unit_test(a_line_has_a_field_for_every_column),
		cmocka_unit_test(the_directions_are_unit_vectors_above_the_horizon),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
