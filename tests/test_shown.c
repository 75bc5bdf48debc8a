/* What people see of names and paths: nothing that a terminal would obey, nothing that makes one look like another. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "error.h"
#include "shown.h"

static void expect(const char *text, const char *shown, int columns)
{
	char out[256];
	shown_text(out, sizeof out, text);
	assert_string_equal(out, shown);
	assert_int_equal(shown_columns(text), columns);
}

static void plain_text_stays_as_it_is(void **state)
{
	(void)state;
	expect("", "", 0);
	expect("alum-bronze 2", "alum-bronze 2", 13);
	expect("caf\xc3\xa9", "caf\xc3\xa9", 4);
	expect("a\\b", "a\\b", 3);
}

static void controls_of_seven_and_eight_bits_are_escaped(void **state)
{
	(void)state;
	expect("\x1b[31m", "\\x1b[31m", 8);
	expect("a\nb\x7f", "a\\x0ab\\x7f", 10);
	expect("\x9b"
	       "31m",
	       "\\x9b31m", 7); /* a raw CSI: no UTF-8 */
	expect("\xc2\x9b"
	       "31m",
	       "\\xc2\\x9b31m", 11);         /* U+009B */
	expect("\xc2\xad", "\\xc2\\xad", 8); /* soft hyphen */
}

static void bidirectional_and_invisible_characters_are_escaped(void **state)
{
	(void)state;
	expect("a\xe2\x80\xae"
	       "b",
	       "a\\xe2\\x80\\xaeb", 14);                        /* U+202E, right-to-left override */
	expect("\xe2\x80\x8b", "\\xe2\\x80\\x8b", 12);          /* U+200B, zero-width space */
	expect("\xe2\x81\xa6", "\\xe2\\x81\\xa6", 12);          /* U+2066, isolate */
	expect("\xef\xbb\xbf", "\\xef\\xbb\\xbf", 12);          /* U+FEFF, byte order mark */
	expect("\xd8\x9c", "\\xd8\\x9c", 8);                    /* U+061C */
	expect("\xf3\xa0\x81\x81", "\\xf3\\xa0\\x81\\x81", 16); /* U+E0041, a tag */
}

static void what_is_no_utf8_is_escaped_byte_by_byte(void **state)
{
	(void)state;
	expect("\xff", "\\xff", 4);
	expect("\xc0\xaf", "\\xc0\\xaf", 8);                    /* overlong */
	expect("\xe2\x82", "\\xe2\\x82", 8);                    /* cut */
	expect("\xed\xa0\x80", "\\xed\\xa0\\x80", 12);          /* a surrogate */
	expect("\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80", 16); /* above U+10FFFF */
	expect("\xe9t\xe9", "\\xe9t\\xe9", 9);                  /* Latin-1 */
}

static void columns_are_those_of_a_terminal(void **state)
{
	(void)state;
	assert_int_equal(shown_columns("\xe9\x87\x91\xe5\xb1\x9e"), 4); /* two Chinese characters */
	assert_int_equal(shown_columns("e\xcc\x81"), 1);                /* e with a combining acute accent */
	assert_int_equal(shown_columns("\xef\xbd\xb1"), 1);             /* half-width katakana */
	assert_int_equal(shown_columns("\xf0\x9f\x94\xa7"), 2);         /* a wrench */
	assert_int_equal(shown_columns("\xea\xb0\x80\xeb\x82\x98"), 4); /* two Hangul syllables */
}

static void a_full_place_ends_between_characters(void **state)
{
	char out[6];
	(void)state;
	assert_int_equal(shown_text(out, sizeof out, "abcd\xc3\xa9"), 4);
	assert_string_equal(out, "abcd");
	assert_int_equal(shown_text(out, sizeof out, "ab\x1b"), 2);
	assert_string_equal(out, "ab");
}

static void messages_are_one_line_that_can_be_shown(void **state)
{
	bp_error error;
	(void)state;
	error_set(&error, BP_ERROR_IO, 0, "%s: cannot open",
	          "a\nb\xc2\x9b"
	          "c\xe2\x80\xae");
	assert_string_equal(error.message, "a\\x0ab\\xc2\\x9bc\\xe2\\x80\\xae: cannot open");
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(plain_text_stays_as_it_is),
		cmocka_unit_test(controls_of_seven_and_eight_bits_are_escaped),
		cmocka_unit_test(bidirectional_and_invisible_characters_are_escaped),
		cmocka_unit_test(what_is_no_utf8_is_escaped_byte_by_byte),
		cmocka_unit_test(columns_are_those_of_a_terminal),
		cmocka_unit_test(a_full_place_ends_between_characters),
		cmocka_unit_test(messages_are_one_line_that_can_be_shown),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
