/*
 * The Archimedean copula baseline: densities against the eight-corner difference of the copula's distribution
 * function (worked out with 60 digits in Python), and recovery of its own parameters.
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

static const struct lattice_dims SMALL = {30, 28, 30};

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

static void recovers(enum archimedean_family family, unsigned turned, float alpha)
{
	static const float SCALE[3] = {0.2F, 0.3F, 0.4F};
	struct archimedean_state *truth, *found;
	struct expansion table;
	struct lattice lattice;
	const struct bench_material material = {.name = "own", .lattice = &lattice};
	void *state;

	assert_int_equal(archimedean_alloc(SMALL, &truth, NULL), BP_OK);
	for (int c = 0; c < 3; c++) {
		truth->channel[c].family = family;
		truth->channel[c].turned = turned;
		truth->channel[c].alpha = alpha;
		truth->channel[c].scale = SCALE[c];
		for (int axis = 0; axis < 3; axis++) {
			const uint32_t extent = axis == 0 ? SMALL.theta_h : axis == 1 ? SMALL.theta_d : SMALL.phi_d;
			for (uint32_t n = 0; n < extent; n++)
				truth->channel[c].marginal[axis][n] = (float)(1 + 0.3 * cos(M_PI * (n + 0.5) / extent));
		}
	}
	archimedean_accumulate(truth);
	assert_int_equal(expansion_alloc(SMALL, &table, NULL), BP_OK);
	assert_int_equal(lattice_alloc(SMALL, &lattice, NULL), BP_OK);
	assert_int_equal(BASELINE_ARCHIMEDEAN.expand(truth, &table, NULL), BP_OK);
	for (size_t cell = 0; cell < lattice_cells(SMALL); cell++) {
		for (int c = 0; c < 3; c++)
			lattice.rgb[c][cell] = table.unit * (double)table.rgb[c][cell];
		lattice.valid[cell] = 1;
	}
	assert_int_equal(BASELINE_ARCHIMEDEAN.fit(&material, 0, &state, NULL), BP_OK);
	found = state;
	for (int c = 0; c < 3; c++) {
		assert_int_equal(found->channel[c].family, family);
		assert_int_equal(found->channel[c].turned, turned);
		assert_close((double)found->channel[c].alpha, (double)alpha, 1e-3);
		assert_close((double)found->channel[c].scale, (double)SCALE[c], 1e-3);
		for (int axis = 0; axis < 3; axis++)
			for (uint32_t n = 0; n < SMALL.theta_d; n++)
				assert_close((double)found->channel[c].marginal[axis][n], (double)truth->channel[c].marginal[axis][n], 1e-3);
	}
	/* 3 x (88 + 3) float32 and a byte per channel */
	assert_int_equal(BASELINE_ARCHIMEDEAN.bytes(state), 1095);
	BASELINE_ARCHIMEDEAN.free_state(state);
	archimedean_free(truth);
	expansion_free(&table);
	lattice_free(&lattice);
}

static void frank_recovers_its_own_parameters(void **unused)
{
	(void)unused;
	recovers(ARCHIMEDEAN_FRANK, 0, 1.2F);
	recovers(ARCHIMEDEAN_FRANK, 2, 1.6F);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(densities_are_the_third_mixed_derivative),
		cmocka_unit_test(little_dependence_is_independence),
		cmocka_unit_test(the_marginals_are_uniform),
		cmocka_unit_test(frank_recovers_its_own_parameters),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
