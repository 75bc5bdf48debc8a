/* spectrum.h: against sums written out, for any extents, and alike on every processor. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/spectral/spectrum_turn.h"
#include "random_tables.h"
#include "spectral_tables.h"

static float *table_random(struct lattice_dims d)
{
	float *table = malloc(lattice_cells(d) * sizeof *table);
	for (size_t i = 0; i < lattice_cells(d); i++)
		table[i] = (float)(uniform() - 0.5);
	return table;
}

/* One level of the 9/7 analysis of a line by its filters (Daubechies and Sweldens 1998, table 2), not by lifting; mirrored ends. */
static void analysis(double *x, uint32_t n)
{
	static const double low[5] = {0.852698679008894, 0.377402855612831, -0.110624404418437, -0.023849465019557,
	                              0.037828455507264};
	static const double high[4] = {0.788485616405583, -0.418092273221617, -0.040689417609164, 0.064538882628697};
	double y[1024];
	for (uint32_t i = 0; i < n; i++) {
		double sum = 0;
		for (int k = -4; k <= 4; k++) {
			int64_t at = (int64_t)i + k;
			while (at < 0 || at >= n)
				at = at < 0 ? -at : 2 * ((int64_t)n - 1) - at;
			const int a = abs(k);
			sum += x[at] * (i % 2 ? (a < 4 ? high[a] : 0) : low[a]);
		}
		y[i % 2 ? (n + 1) / 2 + i / 2 : i / 2] = sum;
	}
	memcpy(x, y, n * sizeof *x);
}

static void slow_forward(struct lattice_dims d, const float *table, double *out)
{
	const uint32_t h = d.theta_h, w = d.theta_d, p = d.phi_d;
	double line[1024];
	for (size_t r = 0; r < (size_t)h * w; r++)
		for (uint32_t m = 0; m < p; m++) {
			double sum = 0;
			for (uint32_t k = 0; k < p; k++)
				sum += (double)table[r * p + k] * cos(M_PI * m * (k + 0.5) / p);
			out[r * p + spectrum_lane(p, m)] = sum * sqrt((m ? 2.0 : 1.0) / p);
		}
	uint32_t rows = h, columns = w;
	for (uint32_t l = 0; l < spectrum_levels(h, w); l++) {
		for (uint32_t q = 0; q < p; q++) {
			for (uint32_t y = 0; y < rows; y++) {
				for (uint32_t x = 0; x < columns; x++)
					line[x] = out[((size_t)y * w + x) * p + q];
				analysis(line, columns);
				for (uint32_t x = 0; x < columns; x++)
					out[((size_t)y * w + x) * p + q] = line[x];
			}
			for (uint32_t x = 0; x < columns; x++) {
				for (uint32_t y = 0; y < rows; y++)
					line[y] = out[((size_t)y * w + x) * p + q];
				analysis(line, rows);
				for (uint32_t y = 0; y < rows; y++)
					out[((size_t)y * w + x) * p + q] = line[y];
			}
		}
		rows = (rows + 1) / 2;
		columns = (columns + 1) / 2;
	}
}

static void the_forward_transform_is_the_sum_written_out(void **unused)
{
	(void)unused;
	for (int n = 0; n < DIMS_COUNT; n++) {
		float *table = table_random(DIMS[n]);
		double *slow = malloc(lattice_cells(DIMS[n]) * sizeof *slow);
		struct spectrum *spectrum = NULL;
		slow_forward(DIMS[n], table, slow);
		assert_int_equal(spectrum_create(DIMS[n], 0, &spectrum, NULL), BP_OK);
		spectrum_forward(spectrum, table, 0);
		for (size_t i = 0; i < lattice_cells(DIMS[n]); i++)
			assert_true(fabs((double)table[i] - slow[i]) < 1e-5);
		spectrum_free(spectrum);
		free(slow);
		free(table);
	}
}

static void all_tables_of_loops_give_the_same_bits(void **unused)
{
	enum { N = 45, WIDTH = 37, COLUMNS = 48 };
	float x[N * WIDTH], first[N * WIDTH], y[N * WIDTH], scratch[N * WIDTH], matrix[WIDTH * COLUMNS], p[N * COLUMNS],
		q[N * COLUMNS];
	(void)unused;
	for (int i = 0; i < N * WIDTH; i++)
		first[i] = x[i] = (float)(uniform() - 0.5);
	for (int i = 0; i < WIDTH * COLUMNS; i++)
		matrix[i] = (float)(uniform() - 0.5);
	spectral_kernels_plain.cosine_product(x, WIDTH, N, WIDTH, matrix, COLUMNS, p, COLUMNS);
	spectral_kernels_plain.cdf97_forward(x, N, WIDTH, WIDTH, scratch);
	for (int n = 1; n < SPECTRAL_TABLES; n++) {
		spectral_table(n)->cosine_product(first, WIDTH, N, WIDTH, matrix, COLUMNS, q, COLUMNS);
		assert_memory_equal(p, q, sizeof p);
		memcpy(y, first, sizeof y);
		spectral_table(n)->cdf97_forward(y, N, WIDTH, WIDTH, scratch);
		assert_memory_equal(x, y, sizeof x);
	}
}

static void the_levels_leave_at_least_eight_coarse_cells(void **unused)
{
	(void)unused;
	assert_int_equal(spectrum_levels(90, 90), 3);
	assert_int_equal(spectrum_levels(14, 1000), 0);
	assert_int_equal(spectrum_levels(15, 15), 1);
	assert_int_equal(spectrum_levels(1024, 1024), SPECTRUM_LEVELS_MAX);
}

/* Turned, a spectrum is that of the table with its rows in reverse; turned again, it is itself. */
static void a_turned_spectrum_is_that_of_the_reversed_table(void **unused)
{
	(void)unused;
	for (int n = 0; n < DIMS_COUNT; n++) {
		const struct lattice_dims d = DIMS[n];
		const size_t rows = (size_t)d.theta_h * d.theta_d, cells = lattice_cells(d);
		float *table = table_random(d), *reversed = malloc(cells * sizeof *table), *turned = malloc(cells * sizeof *table);
		struct spectrum *spectrum = NULL;
		struct spectrum_turn *turn = NULL;
		for (size_t r = 0; r < rows; r++)
			memcpy(reversed + (rows - 1 - r) * d.phi_d, table + r * d.phi_d, d.phi_d * sizeof *table);
		assert_int_equal(spectrum_create(d, 0, &spectrum, NULL), BP_OK);
		assert_int_equal(spectrum_turn_create(spectrum, d, &turn, NULL), BP_OK);
		spectrum_forward(spectrum, table, 0);
		spectrum_forward(spectrum, reversed, 0);
		spectrum_turned(turn, table, turned);
		for (size_t i = 0; i < cells; i++)
			assert_true(fabsf(turned[i] - reversed[i]) < 2e-5f);
		spectrum_turned(turn, turned, turned);
		for (size_t i = 0; i < cells; i++)
			assert_true(fabsf(turned[i] - table[i]) < 2e-5f);
		spectrum_turn_free(turn);
		spectrum_free(spectrum);
		free(turned);
		free(reversed);
		free(table);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_forward_transform_is_the_sum_written_out),
		cmocka_unit_test(all_tables_of_loops_give_the_same_bits),
		cmocka_unit_test(a_turned_spectrum_is_that_of_the_reversed_table),
		cmocka_unit_test(the_levels_leave_at_least_eight_coarse_cells),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
