/* select.h against sorting: every order of values that makes selection slow or wrong elsewhere. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "model/math/select.h"

static uint64_t state = 3;
static uint64_t draw(uint64_t below)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (state >> 33) % below;
}

static double value_of(int order, size_t i, size_t n)
{
	const double t = (double)i, middle = (double)n / 2;
	switch (order) {
	case 0: return t;
	case 1: return -t;
	case 2: return t < middle ? -t : t;
	case 3: return t < middle ? t : -t;
	case 4: return (double)(i % 10);
	case 5: return 7;
	case 6: return (double)draw(2);
	case 7: return t + (double)draw(100);
	default: return (double)draw(1000000);
	}
}
enum { ORDERS = 9 };

static int ascending(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;
	return (x > y) - (x < y);
}

static void assert_selects(double *v, double *sorted, size_t n, size_t k)
{
	const double found = select_kth(v, n, k);
	assert_true(found == sorted[k] && v[k] == found);
	for (size_t i = 0; i < n; i++)
		assert_true(i < k ? v[i] <= found : v[i] >= found);
	qsort(v, n, sizeof *v, ascending);
	assert_memory_equal(v, sorted, n * sizeof *v); /* nothing lost */
}

static void every_rank_of_every_order_is_found(void **user)
{
	(void)user;
	for (int order = 0; order < ORDERS; order++)
		for (size_t n = 1; n <= 40; n++)
			for (size_t k = 0; k < n; k++) {
				double v[40], sorted[40];
				for (size_t i = 0; i < n; i++)
					sorted[i] = v[i] = value_of(order, i, n);
				qsort(sorted, n, sizeof *sorted, ascending);
				assert_selects(v, sorted, n, k);
			}
}

/* A fixed choice of pivots takes minutes for some of these. */
static void many_values_of_every_order_are_no_trouble(void **user)
{
	(void)user;
	const size_t n = 100000;
	double *v = malloc(n * sizeof *v), *sorted = malloc(n * sizeof *sorted);
	for (int order = 0; order < ORDERS; order++)
		for (int r = 0; r < 4; r++) {
			for (size_t i = 0; i < n; i++)
				sorted[i] = v[i] = value_of(order, i, n);
			qsort(sorted, n, sizeof *sorted, ascending);
			assert_selects(v, sorted, n, (size_t[]){0, n / 3, n / 2, n - 1}[r]);
		}
	free(v);
	free(sorted);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_rank_of_every_order_is_found),
		cmocka_unit_test(many_values_of_every_order_are_no_trouble),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
