/* The set of materials of a build, its scratch file, the progress line, and nearest names. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "tool/items.h"
#include "tool/progress.h"
#include "tool/selection.h"
#include "tool/spool.h"

static void two_items_of_one_name_are_refused_with_both_paths(void **state)
{
	(void)state;
	struct items items = {0};
	bp_error error;
	assert_int_equal(items_add(&items, "gold", "a/gold.binary", 1, &error), BP_OK);
	assert_int_equal(items_add(&items, "gold", "b/gold.binary", 1, &error), BP_ERROR_BAD_INPUT);
	assert_non_null(strstr(error.message, "a/gold.binary")); /* the other path is the caller's to put in front */
	assert_int_equal(items.count, 1);
	items_free(&items);
}

static void illegal_names_are_refused(void **state)
{
	(void)state;
	static const char *const names[] = {"", ".", "..", "a/b", "a\nb", "\xff"};
	struct items items = {0};
	bp_error error;
	for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
		assert_int_equal(items_add(&items, names[i], "path", 1, &error), BP_ERROR_BAD_INPUT);
	assert_int_equal(items.count, 0);
	items_free(&items);
}

static void thousands_of_items_are_sorted_and_still_found(void **state)
{
	(void)state;
	struct items items = {0};
	bp_error error;
	char name[32];
	for (int i = 0; i < 5000; i++) {
		snprintf(name, sizeof name, "m%d", (i * 7919) % 5000); /* 7919 is prime to 5000: every number once */
		assert_int_equal(items_add(&items, name, "p", 1, &error), BP_OK);
	}
	items_sort(&items);
	for (size_t i = 1; i < items.count; i++)
		assert_true(strcmp(items.item[i - 1].name, items.item[i].name) < 0);
	assert_int_equal(items_add(&items, "m4321", "p", 1, &error), BP_ERROR_BAD_INPUT);
	items_free(&items);
}

static void the_spool_gives_back_what_was_added(void **state)
{
	(void)state;
	struct spool spool;
	bp_error error;
	uint64_t first, second;
	uint8_t back[5];
	assert_int_equal(spool_open("/tmp/no-such-file.bpk", &spool, &error), BP_OK);
	assert_int_equal(spool_add(&spool, (const uint8_t *)"hello", 5, &first, &error), BP_OK);
	assert_int_equal(spool_add(&spool, (const uint8_t *)"world", 5, &second, &error), BP_OK);
	assert_int_equal(spool_read(&spool, second, back, 5, &error), BP_OK);
	assert_memory_equal(back, "world", 5);
	assert_int_equal(spool_read(&spool, first, back, 5, &error), BP_OK);
	assert_memory_equal(back, "hello", 5);
	assert_int_equal(spool_read(&spool, 8, back, 5, &error), BP_ERROR_IO);
	spool_close(&spool);
	spool_close(&spool);
	assert_int_equal(spool_open("/nowhere/at/all.bpk", &spool, &error), BP_ERROR_IO);
}

static void the_progress_line_fits_the_terminal(void **state)
{
	(void)state;
	char text[256];
	progress_format(text, sizeof text, 80, 12, 50, 0.25, 10);
	assert_string_equal(text, "[##########..............................] 12/50 materials  1.20/s  0:30 left");
	progress_format(text, sizeof text, 80, 3, 0, 0.5, 7200);
	assert_string_equal(text, "[####################....................] 3 materials  0.00/s  2:00:00 left");
	progress_format(text, sizeof text, 20, 12, 50, 0.25, 10);
	assert_in_range(strlen(text), 1, 19);
	progress_format(text, sizeof text, 80, 0, 50, 0, 0);
	assert_non_null(strstr(text, "-:-- left"));
}

static void the_distance_of_names_counts_edits(void **state)
{
	(void)state;
	assert_int_equal(name_distance("kitten", "sitting", 9), 3);
	assert_int_equal(name_distance("", "abc", 9), 3);
	assert_int_equal(name_distance("gold", "gold", 9), 0);
	assert_int_equal(name_distance("kitten", "sitting", 2), 3); /* more than two: stops counting */
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(two_items_of_one_name_are_refused_with_both_paths),
		cmocka_unit_test(illegal_names_are_refused),
		cmocka_unit_test(thousands_of_items_are_sorted_and_still_found),
		cmocka_unit_test(the_spool_gives_back_what_was_added),
		cmocka_unit_test(the_progress_line_fits_the_terminal),
		cmocka_unit_test(the_distance_of_names_counts_edits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
