/* wavelet.h: orthonormal, exactly invertible, for any extents. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/paper/wavelet.h"

static uint64_t state = 3;
static double uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

static const enum wavelet KINDS[] = {WAVELET_HAAR, WAVELET_DAUBECHIES};
static const uint32_t EXTENTS[] = {4, 5, 6, 7, 8, 9, 10, 12, 16, 31, 33, 90, 180};
enum { EXTENT_COUNT = sizeof EXTENTS / sizeof *EXTENTS };

static void an_axis_is_long_enough_and_ends_in_two_to_four_cells(void **user)
{
	(void)user;
	for (uint32_t n = 4; n <= 1024; n++) {
		struct wavelet_axis a = wavelet_axis_for(n);
		uint32_t coarse = a.plane >> a.levels;
		assert_true(a.field == n && a.levels >= 1 && a.plane >= n && a.plane < n + (1u << a.levels));
		assert_true(coarse << a.levels == a.plane && coarse >= 2 && coarse <= 4);
		assert_true(a.plane <= n + n / 2);
	}
	assert_int_equal(wavelet_axis_for(90).plane, 96);
	assert_int_equal(wavelet_axis_for(90).levels, 5);
	assert_int_equal(wavelet_axis_for(180).plane, 192);
	assert_int_equal(wavelet_axis_for(180).levels, 6);
}

static void the_inverse_gives_the_plane_back(void **user)
{
	(void)user;
	for (int q = 0; q < 2; q++)
		for (int r = 0; r < EXTENT_COUNT; r++)
			for (int c = 0; c < EXTENT_COUNT; c++) {
				struct wavelet_axis rows = wavelet_axis_for(EXTENTS[r]), columns = wavelet_axis_for(EXTENTS[c]);
				size_t n = (size_t)rows.plane * columns.plane;
				double *plane = malloc(n * sizeof *plane), *copy = malloc(n * sizeof *copy), *scratch = malloc(n * sizeof *scratch);
				double before = 0, after = 0;
				for (size_t i = 0; i < n; i++) {
					plane[i] = copy[i] = uniform() - 0.5;
					before += copy[i] * copy[i];
				}
				wavelet_forward(KINDS[q], rows, columns, plane, scratch);
				for (size_t i = 0; i < n; i++)
					after += plane[i] * plane[i];
				assert_true(fabs(after - before) <= 1e-12 * before);
				wavelet_inverse(KINDS[q], rows, columns, plane, scratch);
				for (size_t i = 0; i < n; i++)
					assert_true(fabs(plane[i] - copy[i]) <= 1e-12);
				free(plane);
				free(copy);
				free(scratch);
			}
}

/* The inverse of every unit coefficient is a unit vector orthogonal to all others. */
static void the_basis_is_orthonormal(void **user)
{
	(void)user;
	struct wavelet_axis rows = wavelet_axis_for(6), columns = wavelet_axis_for(11);
	size_t n = (size_t)rows.plane * columns.plane;
	double *basis = calloc(n * n, sizeof *basis), *scratch = malloc(n * sizeof *scratch);
	for (int q = 0; q < 2; q++) {
		memset(basis, 0, n * n * sizeof *basis);
		for (size_t i = 0; i < n; i++) {
			basis[i * n + i] = 1;
			wavelet_inverse(KINDS[q], rows, columns, basis + i * n, scratch);
		}
		for (size_t i = 0; i < n; i++)
			for (size_t j = 0; j <= i; j++) {
				double dot = 0;
				for (size_t k = 0; k < n; k++)
					dot += basis[i * n + k] * basis[j * n + k];
				assert_true(fabs(dot - (i == j)) <= 1e-14);
			}
	}
	free(basis);
	free(scratch);
}

static void haar_is_sums_and_differences(void **user)
{
	(void)user;
	struct wavelet_axis a = wavelet_axis_for(4);
	double scratch[16], plane[16] = {0};
	for (int r = 0; r < 4; r++)
		for (int c = 0; c < 4; c++)
			plane[4 * r + c] = c == 0 ? 1 : c == 1 ? 3 : c == 2 ? 10 : 20;
	assert_int_equal(a.levels, 1);
	wavelet_forward(WAVELET_HAAR, a, a, plane, scratch);
	/* Along rows nothing changes: only the two coarse rows are not 0, with sqrt 2 times the row's coefficients. */
	const double want[4] = {4, 30, -2, -10};
	for (int r = 0; r < 4; r++)
		for (int c = 0; c < 4; c++)
			assert_true(fabs(plane[4 * r + c] - (r < 2 ? want[c] : 0)) < 1e-14);
}

/* Two vanishing moments: a linear ramp has no detail except where the period ends. */
static void daubechies_sees_no_detail_in_a_ramp(void **user)
{
	(void)user;
	struct wavelet_axis rows = wavelet_axis_for(4), columns = wavelet_axis_for(32);
	double plane[4 * 32], scratch[4 * 32];
	for (int i = 0; i < 4 * 32; i++)
		plane[i] = 5 + 0.25 * (i % 32);
	wavelet_forward(WAVELET_DAUBECHIES, rows, columns, plane, scratch);
	for (int c = 16; c < 31; c++)
		assert_true(fabs(plane[c]) < 1e-13);
	assert_true(fabs(plane[31]) > 1);
}

static void a_constant_has_only_coarse_coefficients(void **user)
{
	(void)user;
	struct wavelet_axis rows = wavelet_axis_for(90), columns = wavelet_axis_for(180);
	size_t n = (size_t)rows.plane * columns.plane;
	double *plane = malloc(n * sizeof *plane), *scratch = malloc(n * sizeof *scratch);
	for (int q = 0; q < 2; q++) {
		for (size_t i = 0; i < n; i++)
			plane[i] = 3;
		wavelet_forward(KINDS[q], rows, columns, plane, scratch);
		for (size_t i = 0; i < n; i++) {
			int coarse = i / columns.plane < rows.plane >> rows.levels && i % columns.plane < columns.plane >> columns.levels;
			assert_true(fabs(plane[i] - (coarse ? 3 * sqrt((double)(1u << (rows.levels + columns.levels))) : 0)) < 1e-11);
		}
	}
	free(plane);
	free(scratch);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(an_axis_is_long_enough_and_ends_in_two_to_four_cells),
		cmocka_unit_test(the_inverse_gives_the_plane_back),
		cmocka_unit_test(the_basis_is_orthonormal),
		cmocka_unit_test(haar_is_sums_and_differences),
		cmocka_unit_test(daubechies_sees_no_detail_in_a_ramp),
		cmocka_unit_test(a_constant_has_only_coarse_coefficients),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
