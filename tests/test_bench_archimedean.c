/*
 * The Archimedean copula baseline: densities and masses of cells against the eight-corner difference of the copula's
 * distribution function (worked out with 60 digits in Python), and recovery of its own parameters.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "bench/baseline.h"
#include "bench/archimedean.h"

static const struct lattice_dims SMALL = {14, 12, 16};

static void assert_close(double found, double expected, double relative)
{
	if (!(fabs(found - expected) <= relative * fabs(expected)))
		fail_msg("found %.12g, expected %.12g", found, expected);
}

static void densities_are_the_third_mixed_derivative(void **unused)
{
	(void)unused;
	assert_close(archimedean_density(ARCHIMEDEAN_FRANK, 2.5, 0.3, 0.6, 0.8), 0.7730253819151947, 1e-11);
	assert_close(archimedean_density(ARCHIMEDEAN_FRANK, 12, 0.2, 0.25, 0.4), 3.392665627733798, 1e-11);
	assert_close(archimedean_density(ARCHIMEDEAN_CLAYTON, 2.5, 0.3, 0.6, 0.8), 0.397062317216538, 1e-11);
	assert_close(archimedean_density(ARCHIMEDEAN_CLAYTON, 12, 0.2, 0.25, 0.4), 0.04439161221183454, 1e-11);
}

static void little_dependence_is_independence(void **unused)
{
	(void)unused;
	for (int n = 1; n < 10; n++) {
		assert_close(archimedean_density(ARCHIMEDEAN_FRANK, 1e-5, n / 10., 0.5, 1 - n / 20.), 1, 1e-4);
		assert_close(archimedean_density(ARCHIMEDEAN_CLAYTON, 1e-5, n / 10., 0.5, 1 - n / 20.), 1, 1e-4);
	}
}

/* Midpoint sums of the density over one axis pair give the third's uniform marginal. */
static void the_marginals_are_uniform(void **unused)
{
	enum { N = 200 };
	(void)unused;
	for (int n = 1; n < 4; n++) {
		double sum = 0;
		for (int a = 0; a < N; a++)
			for (int b = 0; b < N; b++)
				sum += archimedean_density(ARCHIMEDEAN_FRANK, 4, n / 4., (a + 0.5) / N, (b + 0.5) / N);
		assert_close(sum / (N * N), 1, 1e-3);
	}
}

/* Masses worked out with 60 digits in Python, among them cells at the corners where densities are singular or nearly so. */
static void a_cells_mass_is_the_difference_of_the_distribution(void **unused)
{
	static const struct {
		enum archimedean_family family;
		double alpha, u[2], v[2], w[2], mass;
	} CASES[] = {
		{ARCHIMEDEAN_FRANK, 2.5, {0.3, 0.31}, {0.6, 0.62}, {0.8, 0.85}, 7.4998110706962739e-6},
		{ARCHIMEDEAN_FRANK, 12, {0.2, 0.22}, {0.25, 0.26}, {0.4, 0.45}, 2.9188123891536854e-5},
		{ARCHIMEDEAN_FRANK, 25, {0.98, 1}, {0.99, 1}, {0.98, 0.99}, 0.00081371429643282441},
		{ARCHIMEDEAN_FRANK, 0.05, {0, 0.02}, {0.5, 0.52}, {0.9, 1}, 3.9101233649039627e-5},
		{ARCHIMEDEAN_CLAYTON, 2.5, {0.3, 0.31}, {0.6, 0.62}, {0.8, 0.85}, 3.7400409071760784e-6},
		{ARCHIMEDEAN_CLAYTON, 12, {0.2, 0.22}, {0.25, 0.26}, {0.4, 0.45}, 5.8949597824158817e-7},
		{ARCHIMEDEAN_CLAYTON, 6, {0, 0.02}, {0, 0.01}, {0, 0.03}, 0.0099719495590363636},
		{ARCHIMEDEAN_CLAYTON, 0.05, {0, 0.02}, {0.5, 0.52}, {0.9, 1}, 3.154441714757278e-5},
	};
	(void)unused;
	for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
		const struct copula copula = copula_make(CASES[n].family, CASES[n].alpha);
		struct copula_edge u[2], v[2], w[2];
		for (int side = 0; side < 2; side++) {
			u[side] = copula_edge(CASES[n].family, CASES[n].alpha, CASES[n].u[side]);
			v[side] = copula_edge(CASES[n].family, CASES[n].alpha, CASES[n].v[side]);
			w[side] = copula_edge(CASES[n].family, CASES[n].alpha, CASES[n].w[side]);
		}
		/* 8 corners, each good to a few roundings of a value below 1 (1/alpha times as many for the power or the logarithm) */
		if (!(fabs(copula_cell_mass(&copula, u, v, w) - CASES[n].mass) <= 2e-15 * (1 + 1 / CASES[n].alpha)))
			fail_msg("case %zu: %.17g, expected %.17g", n, copula_cell_mass(&copula, u, v, w), CASES[n].mass);
	}
}

/* A parameter of each channel. */
struct own {
	unsigned turned;
	float alpha, diffuse; /* diffuse in units of the scale */
};

static struct archimedean_state *own_model(enum archimedean_family family, const struct own own[3])
{
	static const float SCALE[3] = {0.2F, 0.3F, 0.4F};
	struct archimedean_state *truth = calloc(1, sizeof *truth);

	assert_non_null(truth);
	truth->dims = SMALL;
	for (int c = 0; c < 3; c++) {
		truth->channel[c].family = family;
		truth->channel[c].turned = own[c].turned;
		truth->channel[c].alpha = own[c].alpha;
		truth->channel[c].scale = SCALE[c];
		truth->channel[c].diffuse = own[c].diffuse * SCALE[c];
		for (int axis = 0; axis < 3; axis++) {
			const uint32_t extent = archimedean_extent(SMALL, axis);
			for (uint32_t n = 0; n < extent; n++)
				truth->channel[c].marginal[axis][n] = (float)(1 + 0.3 * cos(M_PI * (n + 0.5) / extent));
		}
		archimedean_accumulate(SMALL, &truth->channel[c]);
	}
	return truth;
}

static void expand(const struct archimedean_state *state, struct expansion *table)
{
	assert_int_equal(expansion_alloc(SMALL, table, NULL), BP_OK);
	assert_int_equal(BASELINE_ARCHIMEDEAN.expand(state, table, NULL), BP_OK);
}

static void means_over_two_axes_are_the_thirds_marginal(void **unused)
{
	static const struct own OWN[3] = {{0, 7, 0}, {3, 20, 0}, {6, 0.5F, 0}};
	(void)unused;
	for (int family = 0; family < ARCHIMEDEAN_FAMILIES; family++) {
		struct archimedean_state *state = own_model((enum archimedean_family)family, OWN);
		struct expansion table;
		expand(state, &table);
		for (int c = 0; c < 3; c++) {
			double sum[3][16] = {{0}};
			for (uint32_t i = 0; i < SMALL.theta_h; i++)
				for (uint32_t j = 0; j < SMALL.theta_d; j++)
					for (uint32_t k = 0; k < SMALL.phi_d; k++) {
						double x = (double)table.rgb[c][lattice_index(SMALL, i, j, k)] / (double)state->channel[c].scale;
						sum[0][i] += x;
						sum[1][j] += x;
						sum[2][k] += x;
					}
			for (int axis = 0; axis < 3; axis++)
				for (uint32_t n = 0; n < archimedean_extent(SMALL, axis); n++)
					assert_close(sum[axis][n] * archimedean_extent(SMALL, axis) / (double)lattice_cells(SMALL),
					             (double)state->channel[c].marginal[axis][n], 1e-6); /* float32 tables */
		}
		expansion_free(&table);
		free(state);
	}
}

static void recovers(enum archimedean_family family, const struct own own[3])
{
	struct archimedean_state *truth = own_model(family, own), *found;
	struct expansion table;
	struct lattice lattice;
	const struct bench_material material = {.name = "own", .lattice = &lattice};
	struct fitted fitted;

	expand(truth, &table);
	assert_int_equal(lattice_alloc(SMALL, &lattice, NULL), BP_OK);
	for (size_t cell = 0; cell < lattice_cells(SMALL); cell++) {
		for (int c = 0; c < 3; c++)
			lattice.rgb[c][cell] = table.unit * (double)table.rgb[c][cell];
		lattice.valid[cell] = 1;
	}
	assert_int_equal(BASELINE_ARCHIMEDEAN.fit(&BASELINE_ARCHIMEDEAN, &material, &fitted, NULL), BP_OK);
	found = fitted.state;
	for (int c = 0; c < 3; c++) {
		const double scale = (double)truth->channel[c].scale;
		assert_int_equal(found->channel[c].family, family);
		assert_int_equal(found->channel[c].turned, own[c].turned);
		assert_close((double)found->channel[c].alpha, (double)own[c].alpha, 1e-3);
		assert_close((double)found->channel[c].scale, scale, 1e-3);
		assert_true(fabs((double)found->channel[c].diffuse - (double)truth->channel[c].diffuse) <= 1e-3 * scale);
		for (int axis = 0; axis < 3; axis++)
			for (uint32_t n = 0; n < archimedean_extent(SMALL, axis); n++)
				assert_close((double)found->channel[c].marginal[axis][n], (double)truth->channel[c].marginal[axis][n], 1e-3);
	}
	/* 3 x (42 + 3) float32 and a byte per channel */
	assert_int_equal(fitted.bytes, 543);
	BASELINE_ARCHIMEDEAN.free_state(fitted.state);
	free(truth);
	expansion_free(&table);
	lattice_free(&lattice);
}

/* Weak and strong dependence, with and without a diffuse part. */
static void frank_recovers_its_own_parameters(void **unused)
{
	static const struct own OWN[2][3] = {{{0, 0.3F, 0}, {2, 1.6F, 0}, {5, 5, 0.5F}},
	                                     {{0, 14, 0.2F}, {6, 22, 1}, {3, 0.1F, 0.1F}}};
	(void)unused;
	recovers(ARCHIMEDEAN_FRANK, OWN[0]);
	recovers(ARCHIMEDEAN_FRANK, OWN[1]);
}

/* At the strong end a corner's single cell holds several percent of the whole: there the density is singular. */
static void clayton_recovers_its_own_parameters(void **unused)
{
	static const struct own OWN[2][3] = {{{0, 0.15F, 0}, {4, 0.8F, 0.5F}, {3, 2.5F, 0}}, {{0, 9, 0.2F}, {1, 22, 0}, {6, 16, 1}}};
	(void)unused;
	recovers(ARCHIMEDEAN_CLAYTON, OWN[0]);
	recovers(ARCHIMEDEAN_CLAYTON, OWN[1]);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(densities_are_the_third_mixed_derivative),
		cmocka_unit_test(little_dependence_is_independence),
		cmocka_unit_test(the_marginals_are_uniform),
		cmocka_unit_test(a_cells_mass_is_the_difference_of_the_distribution),
		cmocka_unit_test(means_over_two_axes_are_the_thirds_marginal),
		cmocka_unit_test(frank_recovers_its_own_parameters),
		cmocka_unit_test(clayton_recovers_its_own_parameters),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
