/* fill.h: valid cells stay, filled ones are smooth and bounded. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "model/math/fill.h"
#include "model/math/fill_kernels.h"
#define RANDOM_SEED 11
#include "random.h"

static void fill_once(uint32_t rows, uint32_t columns, float *plane, const uint8_t *valid, float empty)
{
	struct fill *fill;
	assert_int_equal(fill_create(rows, columns, &fill, NULL), BP_OK);
	fill_plane(fill, plane, valid, empty);
	free(fill);
}

static void valid_cells_stay_and_filled_ones_lie_between_them(void **user)
{
	(void)user;
	static const uint32_t extents[][2] = {{1, 1}, {1, 7}, {4, 4}, {5, 9}, {90, 180}, {33, 2}};
	static const double shares[] = {0.01, 0.3, 0.99, 1};
	float plane[90 * 180], copy[90 * 180];
	uint8_t valid[90 * 180];
	for (int q = 0; q < 6; q++)
		for (int s = 0; s < 4; s++)
			for (int turn = 0; turn < 4; turn++) {
				size_t n = extents[q][0] * extents[q][1];
				float low = INFINITY, high = -INFINITY;
				for (size_t i = 0; i < n; i++) {
					valid[i] = uniform() < shares[s] || i == n / 2;
					plane[i] = copy[i] = valid[i] ? (float)uniform() : NAN;
					low = valid[i] ? fminf(low, plane[i]) : low;
					high = valid[i] ? fmaxf(high, plane[i]) : high;
				}
				fill_once(extents[q][0], extents[q][1], plane, valid, 0);
				for (size_t i = 0; i < n; i++) {
					if (valid[i])
						assert_true(plane[i] == copy[i]);
					assert_true(plane[i] >= low - 1e-6f && plane[i] <= high + 1e-6f);
				}
			}
}

static void a_single_valid_cell_fills_everything(void **user)
{
	(void)user;
	float plane[13 * 17];
	uint8_t valid[13 * 17] = {0};
	for (int i = 0; i < 13 * 17; i++)
		plane[i] = -1;
	valid[100] = 1;
	plane[100] = 2.5f;
	fill_once(13, 17, plane, valid, 0);
	for (int i = 0; i < 13 * 17; i++)
		assert_true(plane[i] == 2.5f);
}

static void without_any_valid_cell_the_given_value_stands(void **user)
{
	(void)user;
	float plane[20] = {0};
	const uint8_t valid[20] = {0};
	fill_once(4, 5, plane, valid, 7);
	for (int i = 0; i < 20; i++)
		assert_true(plane[i] == 7);
}

/* A harmonic function is what a membrane restores: a plane in the rows, a hole in the middle. */
static void a_hole_in_a_ramp_is_closed_by_the_ramp(void **user)
{
	(void)user;
	float plane[32 * 32];
	uint8_t valid[32 * 32];
	for (int i = 0; i < 32 * 32; i++) {
		int r = i / 32, c = i % 32;
		valid[i] = !(r >= 10 && r < 22 && c >= 8 && c < 20);
		plane[i] = valid[i] ? (float)r : 0;
	}
	fill_once(32, 32, plane, valid, 0);
	for (int i = 0; i < 32 * 32; i++)
		assert_true(fabsf(plane[i] - (float)(i / 32)) < 0.2f);
}

/* Towards a border a table goes on as it is: nothing comes round from the other side. */
static void a_gap_at_the_border_continues_what_is_beside_it(void **user)
{
	(void)user;
	float plane[4 * 64];
	uint8_t valid[4 * 64];
	for (int i = 0; i < 4 * 64; i++) {
		int c = i % 64;
		valid[i] = c >= 8 && c < 56;
		plane[i] = c >= 32 ? 1 : 0;
	}
	fill_once(4, 64, plane, valid, 0);
	for (int r = 0; r < 4; r++)
		for (int c = 0; c < 8; c++)
			assert_true(fabsf(plane[r * 64 + c]) < 0.01f && fabsf(plane[r * 64 + 63 - c] - 1) < 0.01f);
}

/* Filled cells obey the membrane's equation closely. */
static void filled_cells_are_near_the_mean_of_their_neighbours(void **user)
{
	(void)user;
	enum { R = 90, C = 180 };
	static float plane[R * C];
	static uint8_t valid[R * C];
	double squares = 0, n = 0;
	for (int r = 0; r < R; r++)
		for (int c = 0; c < C; c++) {
			valid[r * C + c] = r < 50 + 30 * sin(3.14159 * c / C);
			plane[r * C + c] = valid[r * C + c] ? (float)(sin(0.1 * r) + cos(2 * 3.14159 * c / C)) : 100;
		}
	fill_once(R, C, plane, valid, 0);
	for (int r = 1; r < R - 1; r++)
		for (int c = 1; c < C - 1; c++)
			if (!valid[r * C + c]) {
				float mean = (plane[(r - 1) * C + c] + plane[(r + 1) * C + c] + plane[r * C + c + 1] + plane[r * C + c - 1]) / 4;
				squares += (double)((plane[r * C + c] - mean) * (plane[r * C + c] - mean));
				n++;
			}
	assert_true(sqrt(squares / n) < 2e-3);
}

static void both_kernel_tables_give_the_same_bits(void **user)
{
	(void)user;
	if (!kernels_avx2_usable())
		skip();
	enum { R = 23, C = 41, R2 = 12, C2 = 21 };
	static float fine[2][R * C], coarse[2][R2 * C2], scratch[2 * C + 8];
	static uint8_t valid[R * C], up[2][R2 * C2];
	size_t missing[2];
	for (int i = 0; i < R * C; i++) {
		valid[i] = uniform() < 0.4;
		fine[0][i] = fine[1][i] = (float)uniform();
	}
	for (int k = 0; k < 2; k++) {
		const struct fill_kernels *kernels = k ? &fill_kernels_avx2 : &fill_kernels_plain;
		struct fill_level a = {R, C, fine[k], valid}, b = {R2, C2, coarse[k], up[k]};
		missing[k] = kernels->fill_halve(&a, &b);
		kernels->fill_interpolate(&b, &a, scratch);
		kernels->fill_smooth(&a, 3, scratch);
	}
	assert_true(missing[0] == missing[1]);
	assert_memory_equal(fine[0], fine[1], sizeof fine[0]);
	assert_memory_equal(coarse[0], coarse[1], sizeof coarse[0]);
	assert_memory_equal(up[0], up[1], sizeof up[0]);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(valid_cells_stay_and_filled_ones_lie_between_them),
		cmocka_unit_test(a_single_valid_cell_fills_everything),
		cmocka_unit_test(without_any_valid_cell_the_given_value_stands),
		cmocka_unit_test(a_hole_in_a_ramp_is_closed_by_the_ramp),
		cmocka_unit_test(a_gap_at_the_border_continues_what_is_beside_it),
		cmocka_unit_test(filled_cells_are_near_the_mean_of_their_neighbours),
		cmocka_unit_test(both_kernel_tables_give_the_same_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
