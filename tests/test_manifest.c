/* Lists of materials: what they may look like, and clear errors for what they may not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "tool/build/manifest.h"

#define SHA "d6506c69e44430bfe8ea676f3950599ca3a6bfb1f46b9906da336d13991bd37d"

static bp_error error;

static bp_status parse_bytes(const char *text, size_t bytes, struct manifest *out)
{
	char *copy = malloc(bytes + 1);
	memcpy(copy, text, bytes);
	return manifest_parse(copy, bytes, out, &error);
}

static bp_status parse(const char *text, struct manifest *out) { return parse_bytes(text, strlen(text), out); }

static void refuse(const char *text, const char *wanted)
{
	struct manifest manifest = {0};
	assert_int_not_equal(parse(text, &manifest), BP_OK);
	assert_string_equal(error.message, wanted);
}

static void a_plain_list_has_one_name_per_line(void **state)
{
	(void)state;
	struct manifest manifest;
	assert_int_equal(parse("# nine\r\n\r\nnickel\r\ngold paint\n# end\nalum-bronze", &manifest), BP_OK);
	assert_int_equal(manifest.count, 3);
	assert_string_equal(manifest.entries[0].name, "alum-bronze");
	assert_string_equal(manifest.entries[1].name, "gold paint");
	assert_string_equal(manifest.entries[2].name, "nickel");
	assert_int_equal(manifest.entries[2].line, 3);
	assert_false(manifest.entries[0].has_bytes || manifest.entries[0].has_sha256);
	manifest_free(&manifest);
}

static void a_table_without_a_header_is_name_bytes_sha256(void **state)
{
	(void)state;
	struct manifest manifest;
	assert_int_equal(parse("b\t12\nalum-bronze\t34992012\t" SHA "\n", &manifest), BP_OK);
	assert_int_equal(manifest.count, 2);
	assert_int_equal(manifest.entries[0].bytes, 34992012);
	assert_true(manifest.entries[0].has_sha256);
	assert_int_equal(manifest.entries[0].sha256[0], 0xd6);
	assert_int_equal(manifest.entries[0].sha256[31], 0x7d);
	assert_true(manifest.entries[1].has_bytes);
	assert_false(manifest.entries[1].has_sha256);
	manifest_free(&manifest);
}

static void a_header_names_the_columns_and_others_are_ignored(void **state)
{
	(void)state;
	struct manifest manifest;
	assert_int_equal(parse("# demo\nkind\tsha256\tname\tbytes\nmetal\t\tgold\t7\n", &manifest), BP_OK);
	assert_int_equal(manifest.count, 1);
	assert_string_equal(manifest.entries[0].name, "gold");
	assert_int_equal(manifest.entries[0].bytes, 7);
	assert_false(manifest.entries[0].has_sha256);
	manifest_free(&manifest);
}

static void entries_are_found_by_name(void **state)
{
	(void)state;
	struct manifest manifest;
	assert_int_equal(parse("c\na\nb\n", &manifest), BP_OK);
	assert_string_equal(manifest_find(&manifest, "a")->name, "a");
	assert_string_equal(manifest_find(&manifest, "c")->name, "c");
	assert_null(manifest_find(&manifest, "d"));
	assert_null(manifest_find(&manifest, ""));
	manifest_free(&manifest);
}

static void names_of_measured_files_stand_for_their_materials(void **state)
{
	(void)state;
	struct manifest manifest;
	assert_int_equal(parse("\xEF\xBB\xBFnickel.binary\nmerl/brdfs/gold-paint.BINARY\n./x.binary.gz\nbrass\n", &manifest), BP_OK);
	assert_string_equal(manifest.entries[0].name, "brass");
	assert_string_equal(manifest.entries[1].name, "gold-paint");
	assert_string_equal(manifest.entries[2].name, "nickel");
	assert_string_equal(manifest.entries[3].name, "x");
	manifest_free(&manifest);
	refuse("x\nfolder/x.binary\n", "line 2: 'x' stands in line 1 already");
	assert_int_equal(parse_bytes("\xFF\xFE"
	                             "a\0",
	                             4, &manifest),
	                 BP_ERROR_BAD_INPUT);
	assert_string_equal(error.message, "this is UTF-16; save it as UTF-8");
}

static void another_unicode_form_is_noted(void **state)
{
	(void)state;
	struct manifest manifest;
	assert_int_equal(parse("gru\xCC\x88n\nblue\nh\xC3\xA4utchen\n", &manifest), BP_OK);
	manifest_note_unlisted(&manifest, "gr\xC3\xBCn");
	manifest_note_unlisted(&manifest, "blau");
	assert_true(manifest_find(&manifest, "gru\xCC\x88n")->other_form);
	assert_false(manifest_find(&manifest, "h\xC3\xA4utchen")->other_form);
	assert_false(manifest_find(&manifest, "blue")->other_form);
	manifest_free(&manifest);
}

static void errors_name_the_line(void **state)
{
	(void)state;
	refuse("a\n\nb/c\n", "line 3: illegal name 'b/c': it holds a '/'");
	refuse("a\t12x\n", "line 1: bytes: expected a whole number, found: '12x'");
	refuse("a\t99999999999999999999\n", "line 1: bytes: expected a whole number, found: '99999999999999999999'");
	refuse("a\t-1\n", "line 1: bytes: expected a whole number, found: '-1'");
	refuse("a\t1\t" SHA "0\n", "line 1: sha256: expected 64 hexadecimal digits, found: '" SHA "0'");
	refuse("bytes\tname\n1\n", "line 2: no name in this line: '1'");
	refuse("a\nb\na\n", "line 3: 'a' stands in line 1 already");
	refuse("# nothing\n", "no material is listed");
	refuse("", "no material is listed");
}

static void a_file_with_nul_bytes_is_refused(void **state)
{
	(void)state;
	struct manifest manifest;
	assert_int_equal(parse_bytes("a\n\0b\n", 5, &manifest), BP_ERROR_BAD_INPUT);
	assert_int_equal(error.offset, 2);
}

static void thousands_of_columns_do_no_harm(void **state)
{
	(void)state;
	struct manifest manifest;
	char *text = malloc(5000);
	memset(text, '\t', 5000);
	text[0] = 'a';
	assert_int_equal(manifest_parse(text, 4999, &manifest, &error), BP_OK);
	assert_string_equal(manifest.entries[0].name, "a");
	manifest_free(&manifest);
}

static void another_size_or_sha256_is_refused_with_both(void **state)
{
	(void)state;
	struct manifest manifest;
	uint8_t sha256[32] = {0xab};
	assert_int_equal(parse("a\t12\t" SHA "\n", &manifest), BP_OK);
	assert_int_equal(manifest_check(&manifest.entries[0], 12, manifest.entries[0].sha256, &error), BP_OK);
	assert_int_equal(manifest_check(&manifest.entries[0], 13, sha256, &error), BP_ERROR_BAD_INPUT);
	assert_non_null(strstr(error.message, "12 bytes"));
	assert_non_null(strstr(error.message, "13"));
	assert_int_equal(manifest_check(&manifest.entries[0], 12, sha256, &error), BP_ERROR_BAD_INPUT);
	assert_non_null(strstr(error.message, SHA));
	assert_non_null(strstr(error.message, "ab00000000"));
	manifest_free(&manifest);
}

static void folders_and_missing_files_are_errors(void **state)
{
	(void)state;
	struct manifest manifest;
	assert_int_equal(manifest_read("/", &manifest, &error), BP_ERROR_BAD_INPUT);
	assert_int_equal(manifest_read("/nowhere/at-all", &manifest, &error), BP_ERROR_IO);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_plain_list_has_one_name_per_line),
		cmocka_unit_test(a_table_without_a_header_is_name_bytes_sha256),
		cmocka_unit_test(a_header_names_the_columns_and_others_are_ignored),
		cmocka_unit_test(entries_are_found_by_name),
		cmocka_unit_test(names_of_measured_files_stand_for_their_materials),
		cmocka_unit_test(another_unicode_form_is_noted),
		cmocka_unit_test(errors_name_the_line),
		cmocka_unit_test(a_file_with_nul_bytes_is_refused),
		cmocka_unit_test(thousands_of_columns_do_no_harm),
		cmocka_unit_test(another_size_or_sha256_is_refused_with_both),
		cmocka_unit_test(folders_and_missing_files_are_errors),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
