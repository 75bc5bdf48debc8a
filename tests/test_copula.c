/* marginal.h and copula.h: means over valid cells only, and the paper's eq. 7 as an identity. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/paper/copula.h"
#include "model/paper/paper_kernels.h"

static uint64_t state = 17;
static double uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

static const struct lattice_dims EXTENTS[] = {{4, 4, 4}, {12, 10, 16}, {5, 7, 9}, {31, 9, 13}};
enum { EXTENT_COUNT = sizeof EXTENTS / sizeof *EXTENTS };

static void lattice_make(struct lattice *l, struct lattice_dims dims, double share_invalid, double size)
{
	assert_int_equal(lattice_alloc(dims, l, NULL), BP_OK);
	for (size_t i = 0; i < lattice_cells(dims); i++) {
		bool gone = uniform() < share_invalid;
		for (int c = 0; c < 3; c++)
			l->rgb[c][i] = gone ? -1 : size * exp(8 * uniform() - 4);
	}
	lattice_validate(l);
}

/* Every mean over valid cells again, in long double. */
static void means_are_means_over_valid_cells(void **user)
{
	(void)user;
	for (int q = 0; q < EXTENT_COUNT; q++) {
		const struct lattice_dims d = EXTENTS[q];
		struct lattice l;
		struct density density;
		long double total = 0, sums[3][64] = {{0}}, pair[31 * 16] = {0};
		uint32_t counts[3][64] = {{0}}, pairs[31 * 16] = {0};
		lattice_make(&l, d, 0.4, 1);
		assert_int_equal(density_build(&l, &density, NULL), BP_OK);
		for (uint32_t i = 0; i < d.theta_h; i++)
			for (uint32_t j = 0; j < d.theta_d; j++)
				for (uint32_t k = 0; k < d.phi_d; k++) {
					size_t at = lattice_index(d, i, j, k);
					if (!l.valid[at])
						continue;
					long double v = ((long double)l.rgb[0][at] + l.rgb[1][at] + l.rgb[2][at]) / 3;
					uint32_t index[3] = {i, j, k};
					total += v;
					for (int a = 0; a < 3; a++) {
						sums[a][index[a]] += v;
						counts[a][index[a]]++;
					}
					pair[i * d.phi_d + k] += v;
					pairs[i * d.phi_d + k]++;
				}
		long double mean = total / l.valid_count;
		assert_true(fabsl(density.mean - mean) <= 1e-14L * mean);
		const uint32_t extents[3] = {d.theta_h, d.theta_d, d.phi_d};
		for (int a = 0; a < 3; a++)
			for (uint32_t i = 0; i < extents[a]; i++) {
				assert_int_equal(density.axis[a].count[i], counts[a][i]);
				long double want = counts[a][i] ? sums[a][i] / counts[a][i] / mean : 0;
				assert_true(fabsl(density.axis[a].value[i] - want) <= 2e-14L * want);
			}
		for (uint32_t i = 0; i < d.theta_h * d.phi_d; i++) {
			assert_int_equal(density.hphi.valid[i], pairs[i] != 0);
			long double want = pairs[i] ? pair[i] / pairs[i] / mean : 0;
			assert_true(fabsl(density.hphi.value[i] - want) <= 2e-14L * want);
		}
		density_free(&density);
		lattice_free(&l);
	}
}

static void equation_seven_is_an_identity_on_valid_cells(void **user)
{
	(void)user;
	static const double sizes[] = {1, 1e-300, 1e300, 1e-12};
	for (int q = 0; q < EXTENT_COUNT; q++)
		for (int s = 0; s < 4; s++) {
			const struct lattice_dims d = EXTENTS[q];
			struct lattice l;
			struct density density;
			lattice_make(&l, d, 0.4, sizes[s]);
			assert_int_equal(density_build(&l, &density, NULL), BP_OK);
			double *hd = malloc(d.theta_h * d.theta_d * sizeof *hd), *hphi = malloc(d.theta_h * d.phi_d * sizeof *hphi);
			double *slice = malloc(d.theta_d * d.phi_d * sizeof *slice);
			uint8_t defined[31 * 31];
			copula_hd(&density, hd, defined);
			copula_hphi(&density, hphi, defined);
			for (uint32_t i = 0; i < d.theta_h; i++) {
				copula_slice(&density, i, slice, defined);
				for (uint32_t j = 0; j < d.theta_d; j++)
					for (uint32_t k = 0; k < d.phi_d; k++) {
						size_t at = lattice_index(d, i, j, k);
						assert_int_equal(defined[j * d.phi_d + k], l.valid[at]);
						if (!l.valid[at])
							continue;
						double want = l.rgb[0][at] / 3 + l.rgb[1][at] / 3 + l.rgb[2][at] / 3;
						double got = density.axis[0].value[i] * density.axis[1].value[j] * density.axis[2].value[k] *
						             hd[i * d.theta_d + j] * hphi[i * d.phi_d + k] * slice[j * d.phi_d + k] * density.mean;
						assert_true(fabs(got - want) <= 1e-12 * want);
					}
			}
			free(hd);
			free(hphi);
			free(slice);
			density_free(&density);
			lattice_free(&l);
		}
}

static void independent_angles_have_copulas_of_one(void **user)
{
	(void)user;
	const struct lattice_dims d = {12, 10, 16};
	struct lattice l;
	struct density density;
	assert_int_equal(lattice_alloc(d, &l, NULL), BP_OK);
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++)
			for (uint32_t k = 0; k < d.phi_d; k++)
				for (int c = 0; c < 3; c++)
					l.rgb[c][lattice_index(d, i, j, k)] = exp(-0.3 * i) * (1 + j) * (2 + cos(0.4 * k)) * (c + 1);
	lattice_validate(&l);
	assert_int_equal(density_build(&l, &density, NULL), BP_OK);
	double value[16 * 16];
	uint8_t defined[16 * 16];
	copula_hd(&density, value, defined);
	for (int i = 0; i < 120; i++)
		assert_true(defined[i] && fabs(value[i] - 1) < 1e-12);
	copula_slice(&density, 3, value, defined);
	for (int i = 0; i < 160; i++)
		assert_true(defined[i] && fabs(value[i] - 1) < 1e-12);
	copula_shared(&density, 8, value, defined);
	for (int i = 0; i < 160; i++)
		assert_true(defined[i] && fabs(value[i] - 1) < 1e-12);
	density_free(&density);
	lattice_free(&l);
}

/* 0/0 is undefined, and so is what nothing was measured of; neither is NaN. */
static void dark_and_missing_rows_are_undefined(void **user)
{
	(void)user;
	const struct lattice_dims d = {5, 7, 9};
	struct lattice l;
	struct density density;
	lattice_make(&l, d, 0, 1);
	for (uint32_t k = 0; k < d.phi_d; k++)
		for (int c = 0; c < 3; c++) {
			for (uint32_t j = 0; j < d.theta_d; j++)
				l.rgb[c][lattice_index(d, 1, j, k)] = 0;  /* a dark slice */
			l.rgb[c][lattice_index(d, 2, 3, k)] = -1; /* a row that was not measured */
			l.rgb[c][lattice_index(d, 3, 4, k)] = 0;  /* a dark row */
		}
	lattice_validate(&l);
	assert_int_equal(density_build(&l, &density, NULL), BP_OK);
	double value[64];
	uint8_t defined[64];
	copula_hd(&density, value, defined);
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			assert_int_equal(defined[i * d.theta_d + j], i != 1 && !(i == 2 && j == 3));
			assert_true(isfinite(value[i * d.theta_d + j]));
		}
	assert_true(value[3 * d.theta_d + 4] == 0);
	copula_slice(&density, 1, value, defined);
	for (int i = 0; i < 63; i++)
		assert_true(!defined[i] && value[i] == 0);
	copula_slice(&density, 3, value, defined);
	for (uint32_t j = 0; j < d.theta_d; j++)
		for (uint32_t k = 0; k < d.phi_d; k++)
			assert_int_equal(defined[j * d.phi_d + k], j != 4);
	density_free(&density);
	lattice_free(&l);
}

static void a_lattice_of_zeros_has_mean_zero_and_nothing_defined(void **user)
{
	(void)user;
	struct lattice l;
	struct density density;
	double value[16];
	uint8_t defined[16];
	assert_int_equal(lattice_alloc((struct lattice_dims){4, 4, 4}, &l, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		memset(l.rgb[c], 0, 64 * sizeof(double));
	lattice_validate(&l);
	assert_int_equal(density_build(&l, &density, NULL), BP_OK);
	assert_true(density.mean == 0);
	copula_hd(&density, value, defined);
	for (int i = 0; i < 16; i++)
		assert_true(!defined[i] && value[i] == 0);
	density_free(&density);
	for (int c = 0; c < 3; c++)
		for (int i = 0; i < 64; i++)
			l.rgb[c][i] = -1;
	lattice_validate(&l);
	assert_int_equal(density_build(&l, &density, NULL), BP_ERROR_BAD_INPUT);
	lattice_free(&l);
}

static void sums_near_the_largest_double_do_not_overflow(void **user)
{
	(void)user;
	struct lattice l;
	struct density density;
	assert_int_equal(lattice_alloc((struct lattice_dims){4, 4, 4}, &l, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		for (int i = 0; i < 64; i++)
			l.rgb[c][i] = DBL_MAX;
	lattice_validate(&l);
	assert_int_equal(density_build(&l, &density, NULL), BP_OK);
	assert_true(fabs(density.mean / DBL_MAX - 1) < 1e-12);
	assert_true(fabs(density.value[5] - 1) < 1e-12);
	density_free(&density);
	lattice_free(&l);
}

static void both_kernel_tables_give_the_same_bits(void **user)
{
	(void)user;
	if (!kernels_avx2_usable())
		skip();
	enum { N = 37 };
	double rgb[3][N], value[2][N], column[2][N] = {{0}}, sum[2];
	uint32_t counts[2][N] = {{0}}, count[2];
	uint8_t valid[N];
	for (int i = 0; i < N; i++) {
		valid[i] = uniform() < 0.6;
		for (int c = 0; c < 3; c++)
			rgb[c][i] = uniform();
	}
	const double *const planes[3] = {rgb[0], rgb[1], rgb[2]};
	for (int k = 0; k < 2; k++)
		sum[k] = (k ? paper_kernels_avx2 : paper_kernels_plain).density_row(planes, valid, N, 0.5, value[k], column[k], counts[k], &count[k]);
	assert_true(sum[0] == sum[1] && count[0] == count[1]);
	assert_memory_equal(value[0], value[1], sizeof value[0]);
	assert_memory_equal(column[0], column[1], sizeof column[0]);
	assert_memory_equal(counts[0], counts[1], sizeof counts[0]);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(means_are_means_over_valid_cells),
		cmocka_unit_test(equation_seven_is_an_identity_on_valid_cells),
		cmocka_unit_test(independent_angles_have_copulas_of_one),
		cmocka_unit_test(dark_and_missing_rows_are_undefined),
		cmocka_unit_test(a_lattice_of_zeros_has_mean_zero_and_nothing_defined),
		cmocka_unit_test(sums_near_the_largest_double_do_not_overflow),
		cmocka_unit_test(both_kernel_tables_give_the_same_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
