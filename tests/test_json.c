/* The JSON writer: valid output for every input. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#include "tool/json.h"

static char *text;
static size_t text_bytes;

static FILE *out_open(void) { return open_memstream(&text, &text_bytes); }

/* A value alone. */
static struct json begin(void) { return (struct json){.out = out_open()}; }

static void expect(struct json *json, const char *wanted)
{
	fclose(json->out);
	assert_string_equal(text, wanted);
	free(text);
}

static void members_are_separated_by_commas(void **state)
{
	(void)state;
	struct json json = json_begin(out_open(), false);
	json_integer(&json, "a", 18446744073709551615u);
	json_array(&json, "b");
	json_bool(&json, NULL, true);
	json_number(&json, NULL, INFINITY);
	json_close(&json);
	json_object(&json, "c");
	json_close(&json);
	json_finish(&json);
	expect(&json, "{\"a\": 18446744073709551615, \"b\": [true, null], \"c\": {}}\n");
}

static void an_indented_document_has_one_member_per_line(void **state)
{
	(void)state;
	struct json json = json_begin(out_open(), true);
	json_integer(&json, "a", 1);
	json_array(&json, "b");
	json_integer(&json, NULL, 2);
	json_close(&json);
	json_finish(&json);
	expect(&json, "{\n  \"a\": 1,\n  \"b\": [\n    2\n  ]\n}\n");
}

static void strings_are_escaped(void **state)
{
	(void)state;
	struct json json = begin();
	json_string(&json, NULL, "a\"b\\c\n\x01\x7f/");
	expect(&json, "\"a\\\"b\\\\c\\u000a\\u0001\\u007f/\"");
}

static void bytes_that_are_not_utf8_are_replaced(void **state)
{
	(void)state;
	struct json json = begin();
	/* a good two-byte sequence, a lone continuation, an overlong '/', a surrogate, a cut sequence */
	json_string(&json, NULL, "\xc3\xa9|\x80|\xc0\xaf|\xed\xa0\x80|\xe2\x82");
	expect(&json, "\"\xc3\xa9|\\ufffd|\\ufffd\\ufffd|\\ufffd\\ufffd\\ufffd|\\ufffd\\ufffd\"");
}

static void numbers_read_back_as_the_same_double(void **state)
{
	(void)state;
	static const double values[] = {0.1, 1.0 / 3, 1e-300, 4.9406564584124654e-324, 1.7976931348623157e308, -0.0};
	for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
		struct json json = begin();
		json_number(&json, NULL, values[i]);
		fclose(json.out);
		double back = strtod(text, NULL);
		assert_memory_equal(&back, &values[i], sizeof back);
		free(text);
	}
}

static void numbers_that_are_not_finite_become_null(void **state)
{
	(void)state;
	struct json json = begin();
	json_array(&json, NULL);
	json_number(&json, NULL, (double)NAN);
	json_number(&json, NULL, -(double)INFINITY);
	json_close(&json);
	expect(&json, "[null, null]");
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(members_are_separated_by_commas),
		cmocka_unit_test(an_indented_document_has_one_member_per_line),
		cmocka_unit_test(strings_are_escaped),
		cmocka_unit_test(bytes_that_are_not_utf8_are_replaced),
		cmocka_unit_test(numbers_read_back_as_the_same_double),
		cmocka_unit_test(numbers_that_are_not_finite_become_null),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
