#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

#include "merl/normal_form.h"
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

static void another_unicode_form_is_nearest_whatever_the_length(void **state)
{
	(void)state;
	const char *const names[] = {"bla", "bl\xC3\xA9", "\xE3\x82\xAC", "\xEA\xB0\x81", NULL};
	assert_string_equal(guess("ble\xCC\x81", names), "bl\xC3\xA9");
	assert_string_equal(guess("\xE3\x82\xAB\xE3\x82\x99", names), "\xE3\x82\xAC");             /* a kana and its mark */
	assert_string_equal(guess("\xE1\x84\x80\xE1\x85\xA1\xE1\x86\xA8", names), "\xEA\xB0\x81"); /* three jamo, one syllable */
	assert_true(normal_form_equal("e\xCC\xA3\xCC\x82", "\xE1\xBB\x87"));                       /* two marks */
	assert_true(normal_form_equal("\xE1\xBA\xB9\xCC\x82", "\xE1\xBB\x87"));                    /* one of them composed */
	assert_false(normal_form_equal("bl\xC3\xA9", "bl\xC3\xA9"));                               /* the same */
	assert_false(normal_form_equal("bl\xC3\xA9", "bl\xC3\xA8"));
	assert_false(normal_form_equal("ble", "bl\xC3\xA9"));
	assert_false(normal_form_equal("bl\xE9", "bl\xC3\xA9")); /* no UTF-8 */
}

static void forms_are_found_among_many(void **state)
{
	(void)state;
	struct normal_forms forms = {0};
	char name[32];
	size_t number;
	for (size_t n = 0; n < 500; n++) {
		snprintf(name, sizeof name, "gru\xCC\x88n-%zu", n);
		normal_forms_add(&forms, name, n);
	}
	normal_forms_add(&forms, "plain", 1000);
	assert_int_equal(forms.count, 500);
	assert_true(normal_forms_find(&forms, "gr\xC3\xBCn-321", &number));
	assert_int_equal(number, 321);
	assert_false(normal_forms_find(&forms, "gr\xC3\xBCn-500", &number));
	assert_false(normal_forms_find(&forms, "plain", &number));
	normal_forms_free(&forms);
	assert_false(normal_forms_find(&forms, "gr\xC3\xBCn-1", &number));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_nearest_spelling_is_found),
		cmocka_unit_test(a_beginning_is_near_but_a_typing_error_is_nearer),
		cmocka_unit_test(another_unicode_form_is_nearest_whatever_the_length),
		cmocka_unit_test(forms_are_found_among_many),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
