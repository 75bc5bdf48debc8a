/* fidelity.h against its definition, worked out slowly. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "model/fidelity.h"
#include "model/fidelity_kernels.h"
#include "random.h"

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

static void assert_near(double a, long double want, long double tolerance)
{
	if (!(fabsl(a - want) <= tolerance * want))
		fail_msg("%.17g, expected %.17Lg", a, want);
}

/* The figures by their definition in long double, compared with fidelity_measure's. */
static void assert_defined(const struct pair *p, long double tolerance)
{
	const struct lattice_dims d = p->truth.dims;
	long double logs = 0, cubes = 0, largest = 0, n = 0;
	float *cosine = malloc((size_t)d.theta_d * d.phi_d * sizeof *cosine);
	struct fidelity f;

	for (uint32_t h = 0; h < d.theta_h; h++) {
		lattice_corner_cosines(d, h, cosine);
		for (size_t k = 0; k < (size_t)d.theta_d * d.phi_d; k++) {
			const size_t i = h * (size_t)d.theta_d * d.phi_d + k;
			for (int c = 0; c < 3 && p->truth.valid[i]; c++) {
				long double b = p->truth.rgb[c][i], e = (long double)p->table.unit * p->table.rgb[c][i], cos = cosine[k];
				long double l = log10l((e + 1e-3L) / (b + 1e-3L)), r = cbrtl(b * cos) - cbrtl(e * cos);
				logs += l * l;
				cubes += r * r;
				largest = fmaxl(largest, fabsl(e - b) / (b + 1e-2L));
				n++;
			}
		}
	}
	assert_int_equal(fidelity_measure(&p->truth, &p->table, 1, &f, NULL), BP_OK);
	assert_near(f.log_rmse, sqrtl(logs / n), tolerance);
	assert_near(f.cube_root_rmse, sqrtl(cubes / n), tolerance);
	assert_near(f.largest_relative, largest, tolerance);
	free(cosine);
}

static void the_figures_are_their_definitions(void **user)
{
	(void)user;
	static const struct lattice_dims extents[] = {{4, 4, 4}, {12, 10, 16}, {5, 7, 9}, {9, 31, 67}};
	for (size_t q = 0; q < sizeof extents / sizeof *extents; q++) {
		struct pair p;
		pair_make(&p, extents[q], 0.125, 0.3);
		assert_defined(&p, 1e-12L);
		pair_free(&p);
	}
}

/* Small errors are told from large ones block by block: every size, with black, dim and bright cells among them. */
static void errors_of_every_size_are_measured_as_well(void **user)
{
	(void)user;
	static const double sizes[] = {1e-6, 1e-4, 1e-2, 0.05, 1.0 / 16, 0.07, 0.5, 20};
	for (size_t q = 0; q < 4 * sizeof sizes / sizeof *sizes; q++) {
		struct pair p;
		pair_make(&p, (struct lattice_dims){5, 7, 29}, 0.5, q % 3 ? 0 : 0.6);
		for (int c = 0; c < 3; c++)
			for (size_t i = 0; i < lattice_cells(p.truth.dims); i++) {
				double b = ldexp(uniform(), (int)(40 * uniform()) - 20), size = sizes[q / 4] * uniform();
				if (q % 4 == 1 && i % 50 == 3) /* one that is not small in some blocks */
					size = 3;
				p.table.rgb[c][i] = (float)(b * (1 + size));
				p.truth.rgb[c][i] = p.truth.valid[i] ? 0.5 * (double)p.table.rgb[c][i] / (1 + size) : 0;
				if (q % 4 == 2 && i % 90 == 7) /* black where it was not, or the other way round */
					p.table.rgb[c][i] = 0;
				if (q % 4 == 2 && i % 90 == 8)
					p.truth.rgb[c][i] = 0;
				if (q % 4 == 3 && i % 70 == 9) /* both black, as is much of a table */
					p.truth.rgb[c][i] = 0 * (double)(p.table.rgb[c][i] = 0);
			}
		assert_defined(&p, sizes[q / 4] < 1e-5 ? 1e-10L : 1e-12L);
		pair_free(&p);
	}
}

/* The same relative error in every cell: rounding errors do not cancel. */
static void a_constant_error_is_measured_however_small(void **user)
{
	(void)user;
	for (int q = 0; q < 20; q++) {
		struct pair p;
		const double b = ldexp(1 + uniform(), q - 12);
		pair_make(&p, (struct lattice_dims){5, 7, 29}, 1, 0);
		for (int c = 0; c < 3; c++)
			for (size_t i = 0; i < lattice_cells(p.truth.dims); i++)
				p.truth.rgb[c][i] = (double)(p.table.rgb[c][i] = (float)b) * (1 + 0x1p-26);
		assert_defined(&p, 1e-8L); /* of log2 of 1 + 2e-8, whose last place is 1e-8 of what is over 1 */
		pair_free(&p);
	}
}

static void many_tables_are_measured_as_one_by_one(void **user)
{
	(void)user;
	struct pair p[3];
	struct expansion tables[LAYERS_MAX + 1];
	struct fidelity all[LAYERS_MAX], one;
	for (int t = 0; t < 3; t++)
		pair_make(&p[t], (struct lattice_dims){6, 9, 31}, t ? 0.5 : 1e-3, 0.2);
	for (int t = 0; t < LAYERS_MAX; t++)
		tables[t] = p[t % 3].table;
	for (uint32_t count = 1; count <= LAYERS_MAX; count++) {
		assert_int_equal(fidelity_measure(&p[1].truth, tables, count, all, NULL), BP_OK);
		for (uint32_t t = 0; t < count; t++) {
			assert_int_equal(fidelity_measure(&p[1].truth, &tables[t], 1, &one, NULL), BP_OK);
			assert_memory_equal(&one, &all[t], sizeof one);
		}
	}
	assert_int_equal(fidelity_measure(&p[1].truth, tables, LAYERS_MAX + 1, all, NULL), BP_ERROR_ARGUMENT);
	for (int t = 0; t < 3; t++)
		pair_free(&p[t]);
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
	assert_int_equal(fidelity_measure(&p.truth, &p.table, 1, &f, NULL), BP_OK);
	assert_true(f.log_rmse == 0 && f.cube_root_rmse == 0 && f.largest_relative == 0);
	pair_free(&p);
}

static void what_stands_in_invalid_cells_does_not_count(void **user)
{
	(void)user;
	struct pair p;
	struct fidelity f, g;
	pair_make(&p, (struct lattice_dims){6, 6, 6}, 1, 0.5);
	assert_int_equal(fidelity_measure(&p.truth, &p.table, 1, &f, NULL), BP_OK);
	for (size_t i = 0; i < 216; i++)
		if (!p.truth.valid[i])
			for (int c = 0; c < 3; c++)
				p.table.rgb[c][i] = 1e30f;
	assert_int_equal(fidelity_measure(&p.truth, &p.table, 1, &g, NULL), BP_OK);
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
		assert_int_equal(fidelity_measure(&p.truth, &p.table, 1, &f, NULL), BP_OK);
		assert_true(isfinite(f.log_rmse) && isfinite(f.cube_root_rmse) && isfinite(f.largest_relative));
		pair_free(&p);
	}
}

/* What is beyond all numbers is told as the largest: here 6e307 beside 0, in units of a hundredth. */
static void an_error_beyond_all_numbers_is_the_largest_one(void **user)
{
	struct pair p;
	struct fidelity f;
	(void)user;
	pair_make(&p, (struct lattice_dims){4, 4, 4}, 1e307, 0);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < 64; i++) {
			p.truth.rgb[c][i] = 0;
			p.table.rgb[c][i] = (float)(i % 7);
		}
	assert_int_equal(fidelity_measure(&p.truth, &p.table, 1, &f, NULL), BP_OK);
	assert_true(f.largest_relative == DBL_MAX && isfinite(f.log_rmse));
	pair_free(&p);
}

static void unlike_tables_and_empty_ones_are_refused(void **user)
{
	(void)user;
	struct pair p, q;
	struct fidelity f;
	bp_error error;
	pair_make(&p, (struct lattice_dims){4, 4, 4}, 1, 1);
	pair_make(&q, (struct lattice_dims){4, 4, 5}, 1, 0);
	assert_int_equal(fidelity_measure(&p.truth, &p.table, 1, &f, &error), BP_ERROR_BAD_INPUT);
	assert_int_equal(fidelity_measure(&q.truth, &p.table, 1, &f, &error), BP_ERROR_ARGUMENT);
	pair_free(&p);
	pair_free(&q);
}

static void all_tables_of_loops_give_the_same_bits(void **user)
{
	(void)user;
	if (!kernels_avx2_usable())
		skip();
	struct pair p;
	static float cosine[9 * 31 * 67];
	static uint8_t hidden[9 * 31 * 67];
	pair_make(&p, (struct lattice_dims){9, 31, 67}, 0.5, 0.3);
	for (size_t i = 0; i < 9 * 31 * 67; i++) {
		cosine[i] = (float)uniform();
		hidden[i] = p.truth.valid[i] && i % 1000 > 900;
		if (i % 1024 < 400) /* small errors too */
			p.table.rgb[1][i] = (float)(p.truth.rgb[1][i] * 2.01);
	}
	for (size_t n = 0; n < 9 * 31 * 67; n += 1 + n / 3) {
		struct fidelity_sums a[2] = {0}, b[2] = {0}, c[2] = {0};
		const struct fidelity_table to_a[2] = {{p.table.rgb[1], 0.5, &a[0]}, {p.table.rgb[0], 0.25, &a[1]}};
		const struct fidelity_table to_b[2] = {{p.table.rgb[1], 0.5, &b[0]}, {p.table.rgb[0], 0.25, &b[1]}};
		const struct fidelity_table to_c[2] = {{p.table.rgb[1], 0.5, &c[0]}, {p.table.rgb[0], 0.25, &c[1]}};
		fidelity_kernels_plain.fidelity_slice(p.truth.rgb[1], p.truth.valid, hidden, cosine, n, to_a, 2);
		fidelity_kernels_avx2.fidelity_slice(p.truth.rgb[1], p.truth.valid, hidden, cosine, n, to_b, 2);
		assert_memory_equal(a, b, sizeof a);
		if (!kernels_avx512_usable())
			continue;
		fidelity_kernels_avx512.fidelity_slice(p.truth.rgb[1], p.truth.valid, hidden, cosine, n, to_c, 2);
		assert_memory_equal(a, c, sizeof a);
	}
	pair_free(&p);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_figures_are_their_definitions),
		cmocka_unit_test(errors_of_every_size_are_measured_as_well),
		cmocka_unit_test(a_constant_error_is_measured_however_small),
		cmocka_unit_test(many_tables_are_measured_as_one_by_one),
		cmocka_unit_test(equal_tables_have_no_error),
		cmocka_unit_test(what_stands_in_invalid_cells_does_not_count),
		cmocka_unit_test(extreme_values_give_finite_figures),
		cmocka_unit_test(an_error_beyond_all_numbers_is_the_largest_one),
		cmocka_unit_test(unlike_tables_and_empty_ones_are_refused),
		cmocka_unit_test(all_tables_of_loops_give_the_same_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
