/*
 * The benchmark's inputs: folders, lists and the quick selection.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "bench/inputs.h"
#include "scratch.h"

static char folder[SCRATCH_BYTES];

static void make_file(const char *name, const char *text)
{
	FILE *file = fopen(scratch_in(folder, name), "w");
	assert_non_null(file);
	fputs(text, file);
	fclose(file);
}

static const char *const NAMES[] = {"c.binary", "a.binary", "e.binary", "b.binary", "d.binary", "notes.txt", "list"};

static int make_folder(void **unused)
{
	(void)unused;
	if (scratch_folder(folder))
		return -1;
	for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++)
		make_file(NAMES[n], "# a comment\nb\t35 MB\nd\nno-such\n");
	return 0;
}

static int remove_folder(void **unused)
{
	(void)unused;
	return scratch_remove(folder);
}

static bool find(const char *list, struct source_list *out) { return inputs_find((char *[]){folder}, 1, list, out); }

static void check_names(const struct source_list *inputs, const char *expected)
{
	char found[64] = "";

	for (size_t n = 0; n < inputs->item_count; n++)
		strcat(found, inputs->items[n].name);
	assert_string_equal(found, expected);
}

static void a_folder_gives_its_merl_files_in_order(void **unused)
{
	struct source_list inputs;
	(void)unused;

	assert_true(find(NULL, &inputs));
	check_names(&inputs, "abcde");
	source_list_free(&inputs);
}

static void a_list_keeps_what_it_names(void **unused)
{
	struct source_list inputs;
	(void)unused;

	assert_true(find(scratch_in(folder, "list"), &inputs));
	check_names(&inputs, "bd");
	source_list_free(&inputs);
}

static void the_quick_selection_spreads_over_the_list(void **unused)
{
	struct source_list inputs;
	(void)unused;

	assert_true(find(NULL, &inputs));
	inputs_thin(&inputs, 9);
	check_names(&inputs, "abcde");
	inputs_thin(&inputs, 3);
	check_names(&inputs, "ace");
	inputs_thin(&inputs, 1);
	check_names(&inputs, "a");
	source_list_free(&inputs);
}

static void what_is_not_there_is_refused(void **unused)
{
	struct source_list inputs;
	(void)unused;

	assert_false(inputs_find((char *[]){(char[]){"/nonexistent/folder"}}, 1, NULL, &inputs));
	assert_false(find("/nonexistent/list", &inputs));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_folder_gives_its_merl_files_in_order),
		cmocka_unit_test(a_list_keeps_what_it_names),
		cmocka_unit_test(the_quick_selection_spreads_over_the_list),
		cmocka_unit_test(what_is_not_there_is_refused),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
