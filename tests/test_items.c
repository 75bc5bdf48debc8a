/* The set of materials of a build, and the progress line. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "tool/build/items.h"
#include "tool/progress.h"

static void items_are_sorted_by_the_bytes_of_their_names(void **state)
{
	(void)state;
	struct items items = {0};
	bp_error error;
	char names[1000][16];
	for (int i = 0; i < 1000; i++) {
		snprintf(names[i], sizeof names[i], "m%d", (i * 7919) % 1000); /* 7919 is prime to 1000: every number once */
		assert_int_equal(items_add(&items, &(struct source_item){.name = names[i], .path = names[i]}, false, &error), BP_OK);
	}
	items_sort(&items);
	for (size_t i = 1; i < items.count; i++)
		assert_true(strcmp(items.item[i - 1].source.name, items.item[i].source.name) < 0);
	items_free(&items);
}

static void a_label_names_container_and_member(void **state)
{
	(void)state;
	char label[ITEM_LABEL_BYTES], path[] = "a.zip", member[] = "x/gold.binary";
	item_label(&(struct source_item){.path = path}, label);
	assert_string_equal(label, "a.zip");
	item_label(&(struct source_item){.path = path, .member = member}, label);
	assert_string_equal(label, "a.zip: x/gold.binary");
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

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(items_are_sorted_by_the_bytes_of_their_names),
		cmocka_unit_test(a_label_names_container_and_member),
		cmocka_unit_test(the_progress_line_fits_the_terminal),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
