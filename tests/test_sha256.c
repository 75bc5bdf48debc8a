#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "merl/sha256.h"

static void known_digests_come_out_for_any_split_of_the_input(void **state)
{
	(void)state;
	/* FIPS 180-4, the two-block example */
	const char *text = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
	for (size_t split = 0; split <= strlen(text); split++) {
		struct sha256 sha;
		uint8_t digest[32];
		char hex[SHA256_HEX_CHARACTERS + 1];
		sha256_start(&sha);
		sha256_add(&sha, text, split);
		sha256_add(&sha, text + split, strlen(text) - split);
		sha256_finish(&sha, digest);
		sha256_to_hex(digest, hex);
		assert_string_equal(hex, "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
	}
}

static void hex_is_read_in_either_case_and_nothing_else_is(void **state)
{
	(void)state;
	uint8_t digest[32];
	char hex[SHA256_HEX_CHARACTERS + 1];
	assert_true(sha256_from_hex("248d6a61d20638b8E5C026930c3e6039a33ce45964ff2167f6ecedd419db06C1", digest));
	sha256_to_hex(digest, hex);
	assert_string_equal(hex, "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
	assert_false(sha256_from_hex("", digest));
	assert_false(sha256_from_hex("248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c", digest));
	assert_false(sha256_from_hex("248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1a", digest));
	assert_false(sha256_from_hex("248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06cg", digest));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(known_digests_come_out_for_any_split_of_the_input),
		cmocka_unit_test(hex_is_read_in_either_case_and_nothing_else_is),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
