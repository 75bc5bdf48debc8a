/* spectrum_inverse.h: against FORMAT.md's steps in long double, the inverse of the forward transform, and alike on every processor. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "random_tables.h"
#include "spectral_tables.h"

/* FORMAT.md, "Inverse wavelets", one step of one line. */
static void synthesis(long double *x, uint32_t n)
{
	static const long double factor[4] = {-0.443506852043971L, -0.882911075530934L, 0.052980118572961L, 1.586134342059924L},
							 k = 1.149604398860241L;
	long double z[1024];
	for (uint32_t i = 0; i < n; i++)
		z[i] = i % 2 ? x[(n + 1) / 2 + i / 2] * k : x[i / 2] / k;
	for (uint32_t s = 0; s < 4; s++)
		for (uint32_t i = s % 2; i < n; i += 2)
			z[i] += factor[s] * (z[i ? i - 1 : 1] + z[i + 1 < n ? i + 1 : n - 2]);
	memcpy(x, z, n * sizeof *x);
}

static long double *slow_inverse(struct lattice_dims d, const float *spectrum)
{
	const uint32_t p = d.phi_d;
	const size_t cells = lattice_cells(d);
	long double *wavelets = malloc(cells * sizeof *wavelets), *table = calloc(cells, sizeof *table), line[1024];
	for (size_t i = 0; i < cells; i++)
		wavelets[i] = (long double)spectrum[i];
	for (uint32_t l = spectrum_levels(d.theta_h, d.theta_d); l-- > 0;) {
		const uint32_t h = (d.theta_h + (1u << l) - 1) >> l, w = (d.theta_d + (1u << l) - 1) >> l;
		for (uint32_t q = 0; q < p; q++) {
			for (uint32_t x = 0; x < w; x++) {
				for (uint32_t y = 0; y < h; y++)
					line[y] = wavelets[((size_t)y * d.theta_d + x) * p + q];
				synthesis(line, h);
				for (uint32_t y = 0; y < h; y++)
					wavelets[((size_t)y * d.theta_d + x) * p + q] = line[y];
			}
			for (uint32_t y = 0; y < h; y++) {
				for (uint32_t x = 0; x < w; x++)
					line[x] = wavelets[((size_t)y * d.theta_d + x) * p + q];
				synthesis(line, w);
				for (uint32_t x = 0; x < w; x++)
					wavelets[((size_t)y * d.theta_d + x) * p + q] = line[x];
			}
		}
	}
	for (size_t r = 0; r < (size_t)d.theta_h * d.theta_d; r++)
		for (uint32_t k = 0; k < p; k++)
			for (uint32_t m = 0; m < p; m++)
				table[r * p + k] += sqrtl((m ? 2.0L : 1.0L) / p) * wavelets[r * p + spectrum_lane(p, m)] *
				                    cosl(acosl(-1) * m * (2 * k + 1) / (2 * p));
	free(wavelets);
	return table;
}

static void a_table_is_what_the_format_says_of_its_coefficients(void **unused)
{
	(void)unused;
	for (int n = 0; n < DIMS_COUNT; n++)
		for (int sparse = 0; sparse < 2; sparse++) {
			const size_t cells = lattice_cells(DIMS[n]);
			float *spectrum = malloc(cells * sizeof *spectrum);
			for (size_t i = 0; i < cells; i++)
				spectrum[i] = sparse && uniform() > 0.03 ? 0 : (float)(uniform() - 0.5);
			float *quick = table_of(DIMS[n], 0, spectrum, false);
			long double *slow = slow_inverse(DIMS[n], spectrum);
			for (size_t i = 0; i < cells; i++)
				assert_true(fabsl((long double)quick[i] - slow[i]) < 3e-6L);
			free(spectrum);
			free(quick);
			free(slow);
		}
}

static void the_inverse_gives_the_table_back(void **unused)
{
	(void)unused;
	for (int n = 0; n < DIMS_COUNT; n++) {
		const size_t cells = lattice_cells(DIMS[n]);
		float *table = malloc(cells * sizeof *table), *spectrum = malloc(cells * sizeof *spectrum);
		struct spectrum *forward = NULL;
		for (size_t i = 0; i < cells; i++)
			spectrum[i] = table[i] = (float)(uniform() - 0.5);
		assert_int_equal(spectrum_create(DIMS[n], 0, &forward, NULL), BP_OK);
		spectrum_forward(forward, spectrum, 0);
		float *back = table_of(DIMS[n], 0, spectrum, false);
		for (size_t i = 0; i < cells; i++)
			assert_true(fabsf(back[i] - table[i]) < 3e-6f);
		spectrum_free(forward);
		free(back);
		free(table);
		free(spectrum);
	}
}

static void nothing_gives_a_table_of_zeros(void **unused)
{
	const struct lattice_dims d = {16, 17, 18};
	float *spectrum = calloc(lattice_cells(d), sizeof *spectrum), *table = table_of(d, 0, spectrum, false);
	(void)unused;
	for (size_t i = 0; i < lattice_cells(d); i++)
		assert_true(table[i] == 0);
	free(spectrum);
	free(table);
}

static void half_a_plane_is_every_second_cell_of_the_whole(void **unused)
{
	static const struct {
		uint32_t rows, columns;
	} SIZES[] = {{16, 18}, {30, 16}, {90, 90}, {17, 31}};
	(void)unused;
	for (size_t n = 0; n < sizeof SIZES / sizeof *SIZES; n++) {
		const uint32_t rows = SIZES[n].rows, columns = SIZES[n].columns, levels = spectrum_levels(rows, columns);
		const size_t bytes = (size_t)rows * columns * SPECTRUM_BLOCK * sizeof(float);
		float *whole = aligned_alloc(64, bytes), *half = aligned_alloc(64, bytes);
		for (size_t i = 0; i < bytes / sizeof(float); i++)
			half[i] = whole[i] = (float)(uniform() - 0.5);
		spectral_kernels_get()->cdf97_plane(whole, rows, columns, levels, 0);
		spectral_kernels_get()->cdf97_plane(half, rows, columns, levels, 1);
		for (uint32_t i = 0; i < rows; i += 2)
			for (uint32_t j = 0; j < columns; j += 2)
				assert_memory_equal(whole + (i * columns + j) * SPECTRUM_BLOCK, half + (i * columns + j) * SPECTRUM_BLOCK, 64);
		free(whole);
		free(half);
	}
}

static void all_tables_of_loops_give_the_same_bits(void **unused)
{
	enum { ROWS = 33, COLUMNS = 18, CELLS = ROWS * COLUMNS * SPECTRUM_BLOCK };
	static _Alignas(64) float x[SPECTRAL_TABLES][CELLS];
	(void)unused;
	for (int i = 0; i < CELLS; i++)
		x[0][i] = x[1][i] = x[2][i] = (float)(uniform() - 0.5);
	for (int half = 0; half < 2; half++)
		for (int n = 0; n < SPECTRAL_TABLES; n++) {
			spectral_table(n)->cdf97_plane(x[n], ROWS, COLUMNS, 2, half);
			assert_memory_equal(x[0], x[n], sizeof x[0]);
		}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_table_is_what_the_format_says_of_its_coefficients),
		cmocka_unit_test(the_inverse_gives_the_table_back),
		cmocka_unit_test(nothing_gives_a_table_of_zeros),
		cmocka_unit_test(half_a_plane_is_every_second_cell_of_the_whole),
		cmocka_unit_test(all_tables_of_loops_give_the_same_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
