/* cosines.h: against the sum written out, for lengths of every kind, and alike on every processor. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/spectral/cosines.h"
#include "model/spectral/spectrum.h"
#include "random.h"
#include "spectral_tables.h"

static void expect_the_sum(uint32_t n, size_t rows, float base)
{
	float *table = malloc(rows * n * sizeof *table), *copy = malloc(rows * n * sizeof *copy);
	long double *cosine = malloc(4 * n * sizeof *cosine);
	struct cosines *cosines = NULL;
	for (size_t i = 0; i < rows * n; i++)
		copy[i] = table[i] = (float)(uniform() - 0.5) + base;
	for (uint32_t a = 0; a < 4 * n; a++)
		cosine[a] = cosl(acosl(-1) * a / (2 * n));
	assert_int_equal(cosines_create(n, &cosines, NULL), BP_OK);
	cosines_forward(cosines, table, rows, base);
	for (size_t r = 0; r < rows; r++)
		for (uint32_t m = 0; m < n; m++) {
			long double sum = 0;
			for (uint32_t k = 0; k < n; k++)
				sum += ((long double)copy[r * n + k] - (long double)base) * cosine[(uint64_t)m * (2 * k + 1) % (4 * n)];
			sum *= sqrtl((m ? 2.0L : 1.0L) / n);
			assert_true(fabsl((long double)table[r * n + spectrum_lane(n, m)] - sum) < 2e-6L);
		}
	cosines_free(cosines);
	free(cosine);
	free(table);
	free(copy);
}

static void every_short_length_gives_the_sum(void **unused)
{
	(void)unused;
	for (uint32_t n = 4; n <= 60; n++)
		expect_the_sum(n, 17, 0);
}

static void long_lengths_give_the_sum(void **unused)
{
	static const uint32_t LENGTHS[] = {64, 90, 97, 180, 181, 252, 512, 1023, 1024};
	(void)unused;
	for (size_t i = 0; i < sizeof LENGTHS / sizeof *LENGTHS; i++)
		expect_the_sum(LENGTHS[i], 3, 0);
}

static void any_number_of_rows_is_done_and_the_base_comes_off(void **unused)
{
	(void)unused;
	for (size_t rows = 0; rows < 36; rows++)
		expect_the_sum(20, rows, rows % 2 ? 2 : -0.5f);
}

static void all_tables_of_loops_give_the_same_bits(void **unused)
{
	enum { N = 46, SIZE = N * 16 };
	float in[2 * SIZE], angle[N], out[SPECTRAL_TABLES][4][2 * SIZE];
	(void)unused;
	memset(out, 0, sizeof out);
	for (int i = 0; i < 2 * SIZE; i++)
		in[i] = (float)(uniform() - 0.5);
	for (int i = 0; i < N; i++)
		angle[i] = (float)uniform();
	for (int n = 0; n < SPECTRAL_TABLES; n++) {
		const struct spectral_kernels *kernels = spectral_table(n);
		kernels->cosine_fold(in, N, out[n][0], out[n][0] + SIZE);
		kernels->cosine_rotate(in, N, angle, out[n][1], out[n][1] + SIZE);
		kernels->cosine_join(in, in + SIZE, N, out[n][2], 16);
		kernels->cosine_gather(in, N, 0.25f, out[n][3]);
		kernels->cosine_scatter(in, N, N, out[n][3] + SIZE);
	}
	for (int n = 1; n < SPECTRAL_TABLES; n++)
		assert_memory_equal(out[0], out[n], sizeof out[0]);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_short_length_gives_the_sum),
		cmocka_unit_test(long_lengths_give_the_sum),
		cmocka_unit_test(any_number_of_rows_is_done_and_the_base_comes_off),
		cmocka_unit_test(all_tables_of_loops_give_the_same_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
