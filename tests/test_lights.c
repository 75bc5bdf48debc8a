/* test_lights.c: the fixed lightings. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "render/lights.h"

static double length(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static void directional_lights_are_unit_vectors(void **state)
{
	(void)state;
	struct light lights[LIGHTS_MAX];
	assert_int_equal(lights_make(LIGHTING_KEY, lights), 29);
	for (int i = 0; i < 29; i++)
		assert_true(!lights[i].is_point && fabs(length(lights[i].at) - 1) < 1e-12);
	assert_int_equal(lights_make(LIGHTING_ENV, lights), 400);
	for (int i = 0; i < 400; i++)
		assert_true(!lights[i].is_point && fabs(length(lights[i].at) - 1) < 1e-12);
}

static void key_has_five_strong_lights_and_24_of_fill(void **state)
{
	(void)state;
	static const double STRONG[5] = {3, 1, 0.6, 1.5, 1.5};
	struct light lights[LIGHTS_MAX];
	lights_make(LIGHTING_KEY, lights);
	for (int i = 0; i < 5; i++)
		assert_true(lights[i].weight == STRONG[i]);
	for (int i = 5; i < 29; i++)
		assert_true(lights[i].weight == 0.15);
	/* (0.5, 0.6, 0.8) / sqrt(1.25) */
	assert_true(fabs(lights[0].at[0] - 0.4472135955) < 1e-9 && fabs(lights[0].at[2] - 0.7155417528) < 1e-9);
}

static void the_sky_is_spread_evenly(void **state)
{
	(void)state;
	struct light lights[LIGHTS_MAX];
	double sum[3] = {0, 0, 0};
	lights_make(LIGHTING_ENV, lights);
	for (int i = 0; i < 400; i++)
		for (int q = 0; q < 3; q++)
			sum[q] += lights[i].at[q];
	assert_true(length(sum) < 0.5); /* of 400: no side is favoured */
	assert_true(fabs(lights[0].at[2] - (1 - 1.0 / 400)) < 1e-12 && fabs(lights[399].at[2] + (1 - 1.0 / 400)) < 1e-12);
}

/* Darkest below, facing away from the window: radiance 0.3 over 4 pi/400 sr. */
static void the_sky_is_dark_below_and_bright_in_the_window(void **state)
{
	(void)state;
	struct light lights[LIGHTS_MAX];
	double least = 1e9, most = 0;
	lights_make(LIGHTING_ENV, lights);
	for (int i = 0; i < 400; i++) {
		least = fmin(least, lights[i].weight);
		most = fmax(most, lights[i].weight);
	}
	assert_true(fabs(least - 0.3 * 4 * M_PI / 400) < 1e-9);
	/*
	 * In the window's middle 0.3 + 0.7 * 0.5/sqrt(0.97) + 4 = 4.655; 400 directions stand at most 6 degrees from it,
	 * where 4 cos^40 is still 3.2.
	 */
	assert_true(most > 3.8 * 4 * M_PI / 400 && most < 4.66 * 4 * M_PI / 400);
}

static void point_lights_stand_outside_the_sphere(void **state)
{
	(void)state;
	struct light lights[LIGHTS_MAX];
	int count = lights_make(LIGHTING_POINT, lights);
	assert_true(count >= 1 && count <= LIGHTS_MAX);
	for (int i = 0; i < count; i++)
		assert_true(lights[i].is_point && length(lights[i].at) > 2 && lights[i].weight > 0);
}

static void names_are_found_and_others_refused(void **state)
{
	(void)state;
	enum lighting lighting;
	for (int i = 0; i < LIGHTING_COUNT; i++) {
		assert_true(lighting_find(lighting_name((enum lighting)i), &lighting));
		assert_int_equal(lighting, i);
	}
	assert_false(lighting_find("", &lighting));
	assert_false(lighting_find("keys", &lighting));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(directional_lights_are_unit_vectors),
		cmocka_unit_test(key_has_five_strong_lights_and_24_of_fill),
		cmocka_unit_test(the_sky_is_spread_evenly),
		cmocka_unit_test(the_sky_is_dark_below_and_bright_in_the_window),
		cmocka_unit_test(point_lights_stand_outside_the_sphere),
		cmocka_unit_test(names_are_found_and_others_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
