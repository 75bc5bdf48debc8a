/* wavelet.h: orthonormal, exactly invertible, for any extents, mirrored or not. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/paper/paper_kernels.h"
#include "model/paper/wavelet.h"

static uint64_t state = 3;
static float uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (float)((double)(state >> 11) * 0x1p-53);
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
	assert_true(wavelet_axis_for(2).plane == 2 && wavelet_axis_for(2).levels == 0);
	assert_true(wavelet_axis_for(3).plane == 3 && wavelet_axis_for(3).levels == 0);
	assert_true(wavelet_axis_for(90).plane == 96 && wavelet_axis_for(90).levels == 5);
	assert_true(wavelet_axis_for(180).plane == 192 && wavelet_axis_for(180).levels == 6);
}

/* forward, then inverse: the field again; and the sum of squares is kept. */
static void the_inverse_gives_the_field_back(void **user)
{
	(void)user;
	for (int q = 0; q < 4; q++)
		for (int r = 0; r < EXTENT_COUNT; r++)
			for (int c = 0; c < EXTENT_COUNT; c++) {
				const struct wavelet_plane p = wavelet_plane_for(KINDS[q % 2], EXTENTS[r], EXTENTS[c], q / 2);
				const size_t n = wavelet_field_cells(&p), m = wavelet_cells(&p);
				float *field = malloc(n * sizeof *field), *back = malloc(n * sizeof *back);
				float *coefficient = malloc(m * sizeof *coefficient), *scratch = malloc(3 * m * sizeof *scratch);
				double before = 0, after = 0;
				for (size_t i = 0; i < n; i++) {
					field[i] = uniform() - 0.5f;
					before += (double)(field[i] * field[i]);
				}
				wavelet_forward(&p, field, coefficient, scratch);
				for (size_t i = 0; i < m; i++)
					after += (double)(coefficient[i] * coefficient[i]);
				assert_true(fabs(after - before) <= 1e-6 * before);
				wavelet_inverse(&p, coefficient, back, scratch);
				for (size_t i = 0; i < n; i++)
					assert_true(fabsf(back[i] - field[i]) <= 2e-6f);
				free(field);
				free(back);
				free(coefficient);
				free(scratch);
			}
}

/* The squares of an axis: of the forward transform of each cell. */
static void squares_are_those_of_the_basis(void **user)
{
	(void)user;
	for (int q = 0; q < 2; q++) {
		const struct wavelet_plane p = wavelet_plane_for(KINDS[q], 4, 11, false);
		const uint32_t m = p.columns.plane;
		float *square = wavelet_squares(KINDS[q], p.columns), field[4 * 11], coefficient[4 * 12], scratch[3 * 4 * 12];
		assert_non_null(square);
		assert_int_equal(wavelet_cells(&p), 4 * 12);
		for (uint32_t n = 0; n < 11; n++) {
			memset(field, 0, sizeof field);
			for (uint32_t r = 0; r < 4; r++)
				field[r * 11 + n] = 1;
			wavelet_forward(&p, field, coefficient, scratch);
			for (uint32_t a = 0; a < m;
			     a++) /* a constant along the rows: in their first coarse coefficient, twice the square's root */
				assert_true(fabsf(coefficient[a * 4] * coefficient[a * 4] - 2 * square[a * 11 + n]) < 1e-6f);
		}
		free(square);
	}
}

static void haar_is_sums_and_differences(void **user)
{
	(void)user;
	const struct wavelet_plane p = wavelet_plane_for(WAVELET_HAAR, 4, 4, false);
	float scratch[48], field[16], coefficient[16];
	for (int r = 0; r < 4; r++)
		for (int c = 0; c < 4; c++)
			field[4 * r + c] = c == 0 ? 1 : c == 1 ? 3 : c == 2 ? 10 : 20;
	wavelet_forward(&p, field, coefficient, scratch);
	/* Along rows nothing changes: only the two coarse rows are not 0, with sqrt 2 times the row's coefficients. */
	const float want[4] = {4, 30, -2, -10};
	for (int r = 0; r < 4; r++)
		for (int c = 0; c < 4; c++)
			assert_true(fabsf(coefficient[4 * c + r] - (r < 2 ? want[c] : 0)) < 1e-5f);
}

/* Two vanishing moments: a linear ramp has no detail except where the period ends; one moment of Haar's would see it everywhere. */
static void daubechies_sees_no_detail_in_a_ramp(void **user)
{
	(void)user;
	const struct wavelet_plane p = wavelet_plane_for(WAVELET_DAUBECHIES, 4, 32, false);
	float field[4 * 32], coefficient[4 * 32], scratch[3 * 4 * 32];
	for (int i = 0; i < 4 * 32; i++)
		field[i] = 5 + 0.25f * (float)(i % 32);
	wavelet_forward(&p, field, coefficient, scratch);
	for (int c = 16; c < 31; c++)
		assert_true(fabsf(coefficient[c * 4]) < 1e-5f);
	assert_true(fabsf(coefficient[31 * 4]) > 1);
}

/* What looks the same from both sides has no odd part; its even one is sqrt 2 times the half. */
static void a_mirrored_field_has_no_odd_part(void **user)
{
	(void)user;
	const struct wavelet_plane p = wavelet_plane_for(WAVELET_DAUBECHIES, 6, 13, true);
	const size_t n = wavelet_field_cells(&p), m = wavelet_cells(&p);
	float *field = malloc(n * sizeof *field), *coefficient = malloc(m * sizeof *coefficient),
		  *scratch = malloc(3 * m * sizeof *scratch);
	assert_int_equal(p.parts, 2);
	assert_int_equal(p.columns.field, 7);
	for (size_t r = 0; r < 6; r++)
		for (size_t k = 0; k < 7; k++)
			field[13 * r + k] = field[13 * r + 12 - k] = uniform();
	wavelet_forward(&p, field, coefficient, scratch);
	for (size_t i = m / 2; i < m; i++)
		assert_true(fabsf(coefficient[i]) < 1e-6f);
	free(field);
	free(coefficient);
	free(scratch);
}

static void a_constant_has_only_coarse_coefficients(void **user)
{
	(void)user;
	for (int q = 0; q < 2; q++) {
		const struct wavelet_plane p = wavelet_plane_for(KINDS[q], 32, 16, false);
		float field[32 * 16], coefficient[32 * 16], scratch[3 * 32 * 16];
		for (int i = 0; i < 32 * 16; i++)
			field[i] = 3;
		wavelet_forward(&p, field, coefficient, scratch);
		for (uint32_t i = 0; i < 32u * 16u; i++) {
			const bool coarse = (i % 32u) < (32u >> p.rows.levels) && i / 32u < 16u >> p.columns.levels;
			assert_true(fabsf(coefficient[i] - (coarse ? 3 * sqrtf((float)(1u << (p.rows.levels + p.columns.levels))) : 0)) <
			            1e-4f);
		}
	}
}

static void fill(float *v, size_t n)
{
	for (size_t i = 0; i < n; i++)
		v[i] = uniform() - 0.5f;
}

static void both_kernel_tables_give_the_same_bits(void **user)
{
	(void)user;
	enum { N = 8, W = 37, LARGE = N * W };
	const struct paper_kernels *const tables[2] = {&paper_kernels_plain, &paper_kernels_avx2};
	const struct wavelet_filter filter = {4, {0.48f, 0.84f, 0.22f, -0.13f}, {-0.13f, -0.22f, 0.84f, -0.48f}};
	const struct importance_place place = {0.6f, 0.3f, 0.02f, 1e-4f};
	float in[LARGE], weight[LARGE], out[2][4][LARGE];
	uint8_t valid[LARGE];
	double sums[2][4], measured[LARGE];
	if (!kernels_avx2_usable())
		skip();
	fill(in, LARGE);
	fill(weight, LARGE);
	for (int i = 0; i < LARGE; i++) {
		valid[i] = uniform() < 0.7f;
		weight[i] = weight[i] * weight[i];
		measured[i] = (double)uniform() * 100;
	}
	memset(out, 0, sizeof out);
	memset(sums, 0, sizeof sums);
	for (int k = 0; k < 2; k++) {
		const struct paper_kernels *t = tables[k];
		float(*o)[LARGE] = out[k];
		t->wavelet_split(&filter, in, N, W, o[0], o[0] + LARGE / 2);
		t->wavelet_join(&filter, o[0], o[0] + LARGE / 2, N, W, o[1]);
		memcpy(o[2], in, sizeof in);
		t->residual(weight, o[1], LARGE, o[2]);
		sums[k][0] = t->weigh(weight, o[2], LARGE, o[2]);
		sums[k][1] = t->weigh(weight, o[2], LARGE, o[3]);
		t->add_scaled(0.3f, o[3], LARGE, o[2]);
		t->turn(0.7f, o[2], LARGE, o[3]);
		t->gains(o[2], o[3], weight, 0.01f, LARGE, o[1]);
		t->fit_row(weight, in, o[2], o[3], LARGE, &sums[k][2]);
		t->fit_columns(weight, in, 0.4f, o[3], LARGE, o[2], o[1]);
		t->quotients(weight, in, 2, in, LARGE, o[0], o[3]);
		const double factor[2] = {0.5, 0.25};
		t->normalise_row(measured, valid, factor, LARGE, o[0]);
		t->importance_row(&place, in, o[0], valid, LARGE, o[3]);
	}
	assert_memory_equal(out[0], out[1], sizeof out[0]);
	assert_memory_equal(sums[0], sums[1], sizeof sums[0]);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(an_axis_is_long_enough_and_ends_in_two_to_four_cells),
		cmocka_unit_test(the_inverse_gives_the_field_back),
		cmocka_unit_test(squares_are_those_of_the_basis),
		cmocka_unit_test(haar_is_sums_and_differences),
		cmocka_unit_test(daubechies_sees_no_detail_in_a_ramp),
		cmocka_unit_test(a_mirrored_field_has_no_odd_part),
		cmocka_unit_test(a_constant_has_only_coarse_coefficients),
		cmocka_unit_test(both_kernel_tables_give_the_same_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
