/* The polynomials of fast_math.h keep their documented bounds, against long double. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "model/math/fast_math.h"
#define RANDOM_SEED 1
#include "random.h"

static void the_double_logarithm_keeps_its_bound(void **user)
{
	(void)user;
	for (int k = 0; k < 300000; k++) {
		double x = k % 3 == 0   ? ldexp(1 + uniform(), (int)(uniform() * 2040) - 1020)
		           : k % 3 == 1 ? 0.5 + 1.5 * uniform()
		                        : 1 + (uniform() - 0.5) * 1e-6;
		long double want = log2l((long double)x), gap = fabsl((long double)fast_log2(x) - want);
		assert_true(gap <= (fabsl(want) <= 1 ? 4e-16L : 4e-16L + fabsl(want) * 2.3e-16L));
	}
	assert_true(fast_log2(1) == 0);
	assert_true(fast_log2(1024) == 10);
	assert_true(fast_log2(DBL_MIN) == -1022);
}

static void the_float_logarithm_keeps_its_bound(void **user)
{
	(void)user;
	for (int k = 0; k < 300000; k++) {
		float x = (float)(k % 2 ? ldexp(1 + uniform(), (int)(uniform() * 250) - 125) : 0.5 + 1.5 * uniform());
		double want = log2((double)x), gap = fabs((double)fast_log2f(x) - want);
		assert_true(gap <= (fabs(want) <= 1 ? 1.5e-7 : 1.5e-7 + fabs(want) * 1.2e-7));
	}
	assert_true(fast_log2f(1) == 0);
	assert_true(fast_log2f(0.125f) == -3);
}

static void the_exponentials_keep_their_bounds(void **user)
{
	(void)user;
	for (int k = 0; k < 300000; k++) {
		double x = k % 2 ? uniform() * 2044 - 1022 : uniform() * 4 - 2;
		long double want = exp2l((long double)x);
		assert_true(fabsl((long double)fast_exp2(x) - want) <= 4e-16L * want);
		float y = (float)(k % 2 ? uniform() * 252 - 126 : uniform() * 4 - 2);
		double want_f = exp2((double)y);
		assert_true(fabs((double)fast_exp2f(y) - want_f) <= 2e-7 * want_f);
	}
	assert_true(fast_exp2(-5000) == DBL_MIN);
	assert_true(fast_exp2(5000) == 0x1p1023);
	for (int e = -126; e <= 127; e++)
		assert_true(fast_exp2f((float)e) == (float)ldexp(1, e));
	for (int e = -1022; e <= 1023; e++)
		assert_true(fast_exp2(e) == ldexp(1, e));
}

static void the_cube_root_keeps_its_bound(void **user)
{
	(void)user;
	for (int k = 0; k < 300000; k++) {
		double x = k % 2 ? ldexp(1 + uniform(), (int)(uniform() * 2040) - 1020) : uniform() * 10;
		long double want = cbrtl((long double)x);
		assert_true(fabsl((long double)fast_cbrt(x) - want) <= 1e-15L * want);
	}
	assert_true(fast_cbrt(0) == 0);
	assert_true(fast_cbrt(4.9e-324) >= 0 && fast_cbrt(4.9e-324) < 2e-102);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_double_logarithm_keeps_its_bound),
		cmocka_unit_test(the_float_logarithm_keeps_its_bound),
		cmocka_unit_test(the_exponentials_keep_their_bounds),
		cmocka_unit_test(the_cube_root_keeps_its_bound),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
