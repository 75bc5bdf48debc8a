/* The loops of spectral_values.inc.h: what they say, by the plain way, and alike on every processor. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "random.h"
#include "spectral_tables.h"

enum { N = 203 };

static void random_floats(float *x, size_t n)
{
	for (size_t i = 0; i < n; i++)
		x[i] = (float)(uniform() - 0.5);
}

/* What all tables gave is what the first gave. */
static void assert_alike(const void *results, size_t bytes)
{
	for (int n = 1; n < SPECTRAL_TABLES; n++)
		assert_memory_equal(results, (const char *)results + (size_t)n * bytes, bytes);
}

static void logarithms_of_valid_cells_and_their_sum(void **unused)
{
	double b[N], factor = 512, sum[SPECTRAL_TABLES];
	uint8_t valid[N];
	float out[SPECTRAL_TABLES][N];
	(void)unused;
	for (int i = 0; i < N; i++) {
		b[i] = uniform() * (i % 7 ? 1 : 1e4);
		valid[i] = uniform() < 0.8;
	}
	double want = 0;
	for (int n = 0; n < SPECTRAL_TABLES; n++)
		sum[n] = spectral_table(n)->spectral_logs(b, valid, N, factor, out[n]);
	for (int i = 0; i < N; i++) {
		const double l = valid[i] ? log2(1 + factor * b[i]) : 0;
		assert_true(fabs((double)out[0][i] - l) < 3e-6);
		want += (double)out[0][i];
	}
	assert_true(fabs(sum[0] - want) < 1e-9);
	assert_alike(sum, sizeof sum[0]);
	assert_alike(out, sizeof out[0]);
}

static void moments_weigh_large_coefficients_less(void **unused)
{
	static float x[3][N];
	double want[6] = {0}, got[SPECTRAL_TABLES][6] = {{0}};
	(void)unused;
	for (int f = 0; f < 3; f++)
		random_floats(x[f], N);
	for (int i = 0; i < N; i++) {
		const double r = (double)x[0][i], s = (double)x[1][i], t = (double)x[2][i], w = 1 / (1 + r * r + s * s + t * t);
		const double product[6] = {r * r, r * s, r * t, s * s, s * t, t * t};
		for (int n = 0; n < 6; n++)
			want[n] += w * product[n];
	}
	for (int n = 0; n < SPECTRAL_TABLES; n++)
		spectral_table(n)->spectral_moments((const float *const[]){x[0], x[1], x[2]}, N, got[n]);
	for (int n = 0; n < 6; n++)
		assert_true(fabs(got[0][n] - want[n]) < 1e-10);
	assert_alike(got, sizeof got[0]);
}

static void worths_are_those_of_their_formula(void **unused)
{
	static const struct spectral_light lights[] = {{0.03, 150}, {1, 3}, {3, 1}};
	static double radiance[N], worth[SPECTRAL_TABLES][N], logarithm[SPECTRAL_TABLES][N];
	(void)unused;
	for (int i = 0; i < N; i++)
		radiance[i] = i % 100 ? pow(2, 40 * uniform() - 20) : 0;
	for (size_t n = 0; n <= N; n += n < 20 ? 1 : 61)
		for (int t = 0; t < SPECTRAL_TABLES; t++) {
			for (size_t i = 0; i < n; i++)
				logarithm[t][i] = radiance[i] + 0x1p-63;
			spectral_table(t)->spectral_log2s(logarithm[t], n);
			spectral_table(t)->spectral_worths(radiance, n, lights, 3, 0.3, worth[t]);
		}
	for (int i = 0; i < N; i++) {
		double want = 0;
		for (int l = 0; l < 3; l++) {
			const double x = radiance[i] * lights[l].radiance, slope = pow(x + 0.3, 1 / 2.4 - 1) / fmax(x, 1);
			want += lights[l].count * pow(slope * (x + 0.02 * lights[l].radiance), 2);
		}
		assert_true(fabs(worth[0][i] - want) <= 1e-12 * want);
		assert_true(fabs(logarithm[0][i] - log2(radiance[i] + 0x1p-63)) < 1e-13);
	}
	assert_alike(worth, sizeof worth[0]);
	assert_alike(logarithm, sizeof logarithm[0]);
}

static void a_filled_cell_becomes_the_mean_of_its_neighbours(void **unused)
{
	float x[SPECTRAL_TABLES][N], old[N], beside[4][N], filled[N];
	(void)unused;
	for (int i = 0; i < N; i++)
		filled[i] = uniform() < 0.5 ? 1 : 0;
	for (size_t length = 1; length <= N; length += length < 20 ? 1 : 61) {
		random_floats(old, N);
		for (int n = 0; n < 4; n++)
			random_floats(beside[n], N);
		for (int n = 0; n < SPECTRAL_TABLES; n++) {
			memcpy(x[n], old, sizeof old);
			spectral_table(n)->spectral_smooth(x[n], filled, (const float *const[]){beside[0], beside[1], beside[2], beside[3]},
			                                   length, 0.25f, -0.5f);
		}
		for (size_t i = 0; i < N; i++) {
			const double before = i ? (double)old[i - 1] : 0.25, after = i + 1 < length ? (double)old[i + 1] : -0.5;
			const double mean = (4 * (before + after) + (double)beside[0][i] + (double)beside[1][i] + (double)beside[2][i] +
			                     (double)beside[3][i]) /
			                    12;
			assert_true(i < length && filled[i] > 0 ? fabs((double)x[0][i] - mean) < 1e-6 : x[0][i] == old[i]);
		}
		assert_alike(x, sizeof old);
	}
}

static void a_row_unfolds_about_its_middle(void **unused)
{
	float sum[N], difference[N], out[SPECTRAL_TABLES][N];
	(void)unused;
	random_floats(sum, N);
	random_floats(difference, N);
	for (size_t n = 1; n < N; n++)
		for (int t = 0; t < SPECTRAL_TABLES; t++) {
			memset(out[t], 0, sizeof out[t]);
			spectral_table(t)->span_unfold(sum, difference, n, out[t]);
			for (size_t k = 0; k < N; k++)
				assert_true(out[t][k] == (k >= n                ? 0
				                          : n % 2 && k == n / 2 ? sum[k]
				                          : k < n / 2           ? sum[k] + difference[k]
				                                                : sum[n - 1 - k] - difference[n - 1 - k]));
		}
}

static void coefficients_are_drawn_to_0_by_the_noise_around_them(void **unused)
{
	enum { STRIDE = N + 2 };
	static float square[3][3 * STRIDE], x[SPECTRAL_TABLES][N], old[N], factor[N];
	const float threshold = 0.8f;
	(void)unused;
	random_floats(old, N);
	for (int i = 0; i < N; i++)
		factor[i] = (float)uniform();
	for (int r = 0; r < 3; r++)
		for (int s = 0; s < 3; s++)
			for (int q = 0; q < N; q++)
				square[r][s * STRIDE + q + 1] = r == 1 && s == 1 ? old[q] * old[q] : (float)(0.2 * uniform() * uniform());
	for (int n = 0; n < SPECTRAL_TABLES; n++) {
		memcpy(x[n], old, sizeof old);
		spectral_table(n)->spectral_shrink(x[n], (const float *const[]){square[0] + 1, square[1] + 1, square[2] + 1}, STRIDE,
		                                   factor, threshold, N);
	}
	for (int q = 0; q < N; q++) {
		double energy = q ? 0.5 * pow((double)old[q - 1], 2) : 0;
		energy += q + 1 < N ? 0.5 * pow((double)old[q + 1], 2) : 0;
		for (int r = 0; r < 3; r++)
			for (int s = 0; s < 3; s++)
				energy += (double)square[r][s * STRIDE + q + 1];
		const double keep = fmax(0, 1 - (double)threshold * (double)factor[q] / energy);
		assert_true(fabs((double)x[0][q] - (double)old[q] * keep) < 1e-5);
	}
	assert_alike(x, sizeof old);
}

static void values_are_0_at_and_below_the_logarithms_of_0(void **unused)
{
	enum { ROOM = N + 5 };
	static float field[3][N], rgb[SPECTRAL_TABLES][3][ROOM];
	const float base[3] = {2, 0, -9}, rotation[3][3] = {{0.6f, 0.8f, 0}, {-0.8f, 0.6f, 0}, {0, 0, 1}}, most = 33;
	(void)unused;
	for (int f = 0; f < 3; f++)
		for (int i = 0; i < N; i++)
			field[f][i] = (float)(8 * uniform() - 4);
	field[0][6] = 1e30f;
	for (size_t width = 1; width <= N; width += 101)
		for (int n = 0; n < SPECTRAL_TABLES; n++)
			spectral_table(n)->spectral_values((const float *const[]){field[0], field[1], field[2]}, width, base, rotation, most,
			                                   (float *const[]){rgb[n][0], rgb[n][1], rgb[n][2]});
	for (int c = 0; c < 3; c++)
		for (int k = 0; k < ROOM; k++) {
			const float got = rgb[0][c][k];
			if (k >= N) {
				assert_true(got == 0); /* never written */
				continue;
			}
			double l = (double)base[c];
			for (int f = 0; f < 3; f++)
				l += (double)rotation[f][c] * (double)field[f][k];
			l = l > (double)most ? (double)most : l > 0 ? l : 0;
			assert_true(fabs((double)got - (exp2(l) - 1)) <= 1e-5 * exp2(l));
			assert_true(l > 0 || got == 0);
		}
	assert_alike(rgb, sizeof rgb[0]);
}

/* Fours of rows and what is left of them; of these 48 columns at once and what is left: the sum in ascending order, nothing beside it. */
static void products_of_rows_with_a_matrix(void **unused)
{
	enum { COUNT = 11, IN = 13, OUT = 150, ROWS = 9 };
	float in[ROWS * IN], matrix[COUNT * 144], out[(ROWS + 1) * OUT];
	(void)unused;

	random_floats(in, ROWS * IN);
	random_floats(matrix, COUNT * 144);
	for (int k = 0; k < SPECTRAL_TABLES; k++)
		for (size_t rows = 0; rows <= ROWS; rows++)
			for (size_t columns = 16; columns <= 144; columns += 16) {
				memset(out, 0, sizeof out);
				spectral_table(k)->cosine_product(in, IN, rows, COUNT, matrix, columns, out, OUT);
				for (size_t r = 0; r <= ROWS; r++)
					for (size_t c = 0; c < OUT; c++) {
						volatile float sum = 0; /* every step rounded */
						for (size_t m = 0; m < COUNT && r < rows && c < columns; m++) {
							volatile const float part = in[r * IN + m] * matrix[m * columns + c];
							sum = sum + part;
						}
						assert_true(out[r * OUT + c] == sum);
					}
			}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(products_of_rows_with_a_matrix),
		cmocka_unit_test(logarithms_of_valid_cells_and_their_sum),
		cmocka_unit_test(moments_weigh_large_coefficients_less),
		cmocka_unit_test(worths_are_those_of_their_formula),
		cmocka_unit_test(a_filled_cell_becomes_the_mean_of_its_neighbours),
		cmocka_unit_test(a_row_unfolds_about_its_middle),
		cmocka_unit_test(coefficients_are_drawn_to_0_by_the_noise_around_them),
		cmocka_unit_test(values_are_0_at_and_below_the_logarithms_of_0),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
