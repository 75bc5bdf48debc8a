/* The stage clock: off it is not there, on it charges each stage with what passed in it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "stage.h"

static double thread_seconds(void)
{
	struct timespec now;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Until the thread has worked that long. */
static void work(double seconds)
{
	const double start = thread_seconds();
	while (thread_seconds() - start < seconds)
		;
}

static void without_a_clock_nothing_is_remembered(void **unused)
{
	(void)unused;
	assert_null(stage_clock_running);
	assert_int_equal(stage_enter(STAGE_CODE), STAGE_REST);
	assert_int_equal(stage_enter(STAGE_READ), STAGE_REST);
	stage_clock_stop();
}

static void each_stage_is_charged_with_what_passes_in_it(void **unused)
{
	struct stage_clock clock;
	double start = thread_seconds(), sum = 0;
	(void)unused;
	stage_clock_start(&clock);
	assert_int_equal(stage_enter(STAGE_READ), STAGE_REST);
	work(0.001);
	assert_int_equal(stage_enter(STAGE_CHECKSUM), STAGE_READ);
	work(0.002);
	assert_int_equal(stage_enter(STAGE_READ), STAGE_CHECKSUM);
	work(0.001);
	stage_clock_stop();
	double whole = thread_seconds() - start;
	for (int stage = 0; stage < STAGE_COUNT; stage++)
		sum += clock.seconds[stage];
	assert_true(clock.seconds[STAGE_READ] >= 0.002 && clock.seconds[STAGE_CHECKSUM] >= 0.002);
	assert_true(clock.seconds[STAGE_MEASURE] == 0);
	assert_true(sum <= whole + 1e-9 && sum >= 0.004);
	assert_null(stage_clock_running);
}

static void a_clock_starts_at_nothing(void **unused)
{
	struct stage_clock clock;
	(void)unused;
	memset(&clock, 0x7f, sizeof clock);
	stage_clock_start(&clock);
	stage_clock_stop();
	for (int stage = 1; stage < STAGE_COUNT; stage++)
		assert_true(clock.seconds[stage] == 0);
}

static void every_stage_has_a_name_of_its_own(void **unused)
{
	(void)unused;
	for (int a = 0; a < STAGE_COUNT; a++)
		for (int b = 0; b < a; b++)
			assert_string_not_equal(stage_name((enum stage)a), stage_name((enum stage)b));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(without_a_clock_nothing_is_remembered),
		cmocka_unit_test(each_stage_is_charged_with_what_passes_in_it),
		cmocka_unit_test(a_clock_starts_at_nothing),
		cmocka_unit_test(every_stage_has_a_name_of_its_own),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
