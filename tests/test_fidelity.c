/* fidelity.h against its definition, worked out slowly. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/fidelity.h"
#include "model/kernels.h"

static uint64_t state = 5;
static double uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

struct pair {
	struct lattice truth;
	struct expansion table;
};

static void pair_make(struct pair *p, struct lattice_dims dims, double unit, double share_invalid)
{
	size_t cells = lattice_cells(dims);
	assert_int_equal(lattice_alloc(dims, &p->truth, NULL), BP_OK);
	assert_int_equal(expansion_alloc(dims, &p->table, NULL), BP_OK);
	p->table.unit = unit;
	for (size_t i = 0; i < cells; i++) {
		double b = exp(6 * uniform() - 5), gone = uniform() < share_invalid ? -1 : 1;
		for (int c = 0; c < 3; c++) {
			p->truth.rgb[c][i] = gone < 0 ? -1 : b * (1 + 0.2 * c);
			p->table.rgb[c][i] = (float)(b * (0.8 + 0.4 * uniform()) / unit);
		}
	}
	lattice_validate(&p->truth);
}

static void pair_free(struct pair *p)
{
	lattice_free(&p->truth);
	expansion_free(&p->table);
}

static void assert_near(double a, long double want)
{
	if (!(fabsl(a - want) <= 1e-12L * want))
		fail_msg("%.17g, expected %.17Lg", a, want);
}

static void the_figures_are_their_definitions(void **user)
{
	(void)user;
	static const struct lattice_dims extents[] = {{4, 4, 4}, {12, 10, 16}, {5, 7, 9}, {9, 31, 67}};
	for (size_t q = 0; q < sizeof extents / sizeof *extents; q++) {
		const struct lattice_dims d = extents[q];
		struct pair p;
		struct fidelity f;
		pair_make(&p, d, 0.125, 0.3);
		assert_int_equal(fidelity_measure(&p.truth, &p.table, &f, NULL), BP_OK);
		long double logs = 0, cubes = 0, largest = 0, n = 0;
		float *cosine = malloc(lattice_cells(d) * sizeof *cosine);
		assert_int_equal(lattice_corner_cosine(d, cosine, NULL), BP_OK);
		for (size_t i = 0; i < lattice_cells(d); i++)
			for (int c = 0; c < 3 && p.truth.valid[i]; c++) {
				long double b = p.truth.rgb[c][i], e = 0.125L * p.table.rgb[c][i], cos = cosine[i];
				long double l = log10l((e + 1e-3L) / (b + 1e-3L)), k = cbrtl(b * cos) - cbrtl(e * cos);
				logs += l * l;
				cubes += k * k;
				largest = fmaxl(largest, fabsl(e - b) / (b + 1e-2L));
				n++;
			}
		assert_near(f.log_rmse, sqrtl(logs / n));
		assert_near(f.cube_root_rmse, sqrtl(cubes / n));
		assert_near(f.largest_relative, largest);
		free(cosine);
		pair_free(&p);
	}
}

static void equal_tables_have_no_error(void **user)
{
	(void)user;
	struct pair p;
	struct fidelity f;
	pair_make(&p, (struct lattice_dims){6, 6, 6}, 1, 0.5);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < 216; i++)
			p.truth.rgb[c][i] = (double)(p.table.rgb[c][i] = 0.25f + (float)i);
	assert_int_equal(fidelity_measure(&p.truth, &p.table, &f, NULL), BP_OK);
	assert_true(f.log_rmse == 0 && f.cube_root_rmse == 0 && f.largest_relative == 0);
	pair_free(&p);
}

static void what_stands_in_invalid_cells_does_not_count(void **user)
{
	(void)user;
	struct pair p;
	struct fidelity f, g;
	pair_make(&p, (struct lattice_dims){6, 6, 6}, 1, 0.5);
	assert_int_equal(fidelity_measure(&p.truth, &p.table, &f, NULL), BP_OK);
	for (size_t i = 0; i < 216; i++)
		if (!p.truth.valid[i])
			for (int c = 0; c < 3; c++)
				p.table.rgb[c][i] = 1e30f;
	assert_int_equal(fidelity_measure(&p.truth, &p.table, &g, NULL), BP_OK);
	assert_memory_equal(&f, &g, sizeof f);
	pair_free(&p);
}

static void extreme_values_give_finite_figures(void **user)
{
	(void)user;
	static const double sizes[] = {1e300, 1e-300};
	for (int k = 0; k < 4; k++) {
		struct pair p;
		struct fidelity f;
		pair_make(&p, (struct lattice_dims){4, 4, 4}, sizes[k / 2], 0);
		for (int c = 0; c < 3; c++)
			for (size_t i = 0; i < 64; i++) {
				p.truth.rgb[c][i] = sizes[k % 2] * (double)i;
				p.table.rgb[c][i] = (float)(i % 7);
			}
		assert_int_equal(fidelity_measure(&p.truth, &p.table, &f, NULL), BP_OK);
		assert_true(isfinite(f.log_rmse) && isfinite(f.cube_root_rmse) && isfinite(f.largest_relative));
		pair_free(&p);
	}
}

static void unlike_tables_and_empty_ones_are_refused(void **user)
{
	(void)user;
	struct pair p, q;
	struct fidelity f;
	bp_error error;
	pair_make(&p, (struct lattice_dims){4, 4, 4}, 1, 1);
	pair_make(&q, (struct lattice_dims){4, 4, 5}, 1, 0);
	assert_int_equal(fidelity_measure(&p.truth, &p.table, &f, &error), BP_ERROR_BAD_INPUT);
	assert_int_equal(fidelity_measure(&q.truth, &p.table, &f, &error), BP_ERROR_ARGUMENT);
	pair_free(&p);
	pair_free(&q);
}

static void both_kernel_tables_give_the_same_bits(void **user)
{
	(void)user;
	if (!kernels_avx2_usable())
		skip();
	struct pair p;
	static float cosine[9 * 31 * 67];
	pair_make(&p, (struct lattice_dims){9, 31, 67}, 0.5, 0.3);
	assert_int_equal(lattice_corner_cosine(p.truth.dims, cosine, NULL), BP_OK);
	for (size_t n = 0; n < 9 * 31 * 67; n += 1 + n / 3) {
		struct fidelity_sums a = {0}, b = {0};
		kernels_plain.fidelity_slice(p.truth.rgb[1], p.table.rgb[1], p.truth.valid, cosine, n, 0.5, &a);
		kernels_avx2.fidelity_slice(p.truth.rgb[1], p.table.rgb[1], p.truth.valid, cosine, n, 0.5, &b);
		assert_memory_equal(&a, &b, sizeof a);
	}
	pair_free(&p);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_figures_are_their_definitions),
		cmocka_unit_test(equal_tables_have_no_error),
		cmocka_unit_test(what_stands_in_invalid_cells_does_not_count),
		cmocka_unit_test(extreme_values_give_finite_figures),
		cmocka_unit_test(unlike_tables_and_empty_ones_are_refused),
		cmocka_unit_test(both_kernel_tables_give_the_same_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
