#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "merl/spelling.h"

static const char *guess(const char *wanted, const char *const *names)
{
	static struct name_guess guess;
	name_guess_start(&guess, wanted);
	for (; *names; names++)
		name_guess_offer(&guess, *names);
	return name_guess_best(&guess);
}

static void the_nearest_spelling_is_found(void **state)
{
	(void)state;
	const char *const names[] = {"alum-bronze", "nickel", "nylon", "gold-paint", "gold-metallic-paint", "pvc", NULL};
	assert_string_equal(guess("nickle", names), "nickel");
	assert_string_equal(guess("NICKEL", names), "nickel");
	assert_string_equal(guess("nikel", names), "nickel");
	assert_string_equal(guess("gold-metalic-paint", names), "gold-metallic-paint");
	assert_string_equal(guess("goldpaint", names), "gold-paint");
	assert_string_equal(guess("pcv", names), "pvc");
	assert_null(guess("chrome-steel", names));
	assert_null(guess("", names));
	const char *const none[] = {NULL};
	assert_null(guess("nickel", none));
}

static void a_beginning_is_near_but_a_typing_error_is_nearer(void **state)
{
	(void)state;
	const char *const names[] = {"chrome-steel", "chroma", "gold-metallic-paint", "gold-paint", NULL};
	assert_string_equal(guess("chrom", names), "chroma");
	assert_string_equal(guess("Chrome-s", names), "chrome-steel");
	assert_string_equal(guess("gold", names), "gold-metallic-paint");
	assert_null(guess("go", names));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_nearest_spelling_is_found),
		cmocka_unit_test(a_beginning_is_near_but_a_typing_error_is_nearer),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
