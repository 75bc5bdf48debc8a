/*
 * Repeated Tucker decomposition: recovers a tensor of its own form, and its size follows the budget.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "bench/baseline.h"
#include "bench/tucker.h"

static const struct lattice_dims SMALL = {24, 20, 32};

/* Two orthogonal terms of unit length per axis: cosines of whole periods; sizes 30 and 6. */
static double factor(int term, int axis, uint32_t n)
{
	const uint32_t extent = axis == 0 ? SMALL.theta_h : axis == 1 ? SMALL.theta_d : SMALL.phi_d;

	return sqrt(2.0 / extent) * cos(2 * M_PI * (term + 1) * (n + 0.25 * axis) / extent);
}

static const double COLOUR[2][3] = {{2. / 3, 2. / 3, 1. / 3}, {1. / 3, -2. / 3, 2. / 3}}, SIZE[2] = {30, 6};

static double logarithm(uint32_t i, uint32_t j, uint32_t k, int c)
{
	double sum = 0;

	for (int t = 0; t < 2; t++)
		sum += SIZE[t] * factor(t, 0, i) * factor(t, 1, j) * factor(t, 2, k) * COLOUR[t][c];
	return sum;
}

static struct lattice make_table(void)
{
	struct lattice lattice;

	assert_int_equal(lattice_alloc(SMALL, &lattice, NULL), BP_OK);
	for (uint32_t i = 0; i < SMALL.theta_h; i++)
		for (uint32_t j = 0; j < SMALL.theta_d; j++)
			for (uint32_t k = 0; k < SMALL.phi_d; k++) {
				size_t cell = lattice_index(SMALL, i, j, k);
				lattice.valid[cell] = 1;
				for (int c = 0; c < 3; c++)
					lattice.rgb[c][cell] = exp(logarithm(i, j, k, c)) - LOG_OFFSET;
			}
	lattice.valid_count = lattice_cells(SMALL);
	return lattice;
}

/* A factor is known up to its sign; the signs of all four multiply to +1. */
static double recovered_sign(const float *found, size_t stride, int term, int axis, uint32_t extent)
{
	double along = 0;

	for (uint32_t n = 0; n < extent; n++)
		along += (double)found[n * stride] * factor(term, axis, n);
	for (uint32_t n = 0; n < extent; n++) {
		double expected = copysign(factor(term, axis, n), along * factor(term, axis, n));
		if (!(fabs((double)found[n * stride] - expected) <= 1e-4))
			fail_msg("term %d, axis %d, entry %u: %g, expected %g", term, axis, n, (double)found[n * stride], expected);
	}
	return along < 0 ? -1 : 1;
}

static void a_tensor_of_two_terms_is_recovered(void **unused)
{
	struct lattice lattice = make_table();
	struct log_tensor tensor;
	struct tucker_state *state;
	(void)unused;

	assert_int_equal(log_tensor_make(&lattice, &tensor, NULL), BP_OK);
	assert_int_equal(tucker_decompose(&tensor, 2, &state, NULL), BP_OK);
	assert_int_equal(state->terms, 2);
	for (uint32_t t = 0; t < 2; t++) {
		double sign = recovered_sign(state->u + t, state->stride, (int)t, 0, SMALL.theta_h) *
		              recovered_sign(state->v + t, state->stride, (int)t, 1, SMALL.theta_d) *
		              recovered_sign(state->w + t, state->stride, (int)t, 2, SMALL.phi_d);
		for (uint32_t c = 0; c < 3; c++)
			if (!(fabs(sign * (double)state->z[c * state->stride + t] - SIZE[t] * COLOUR[t][c]) <= 1e-3 * SIZE[t]))
				fail_msg("term %u, colour %u: %g", t, c, (double)state->z[c * state->stride + t]);
	}
	tucker_free(state);
	log_tensor_free(&tensor);
	lattice_free(&lattice);
}

static void the_table_comes_back_and_holes_are_ignored(void **unused)
{
	struct lattice lattice = make_table();
	const struct bench_material material = {.name = "two-terms", .lattice = &lattice, .budget_bytes = 4000};
	struct expansion table;
	struct fitted fitted;
	(void)unused;

	assert_int_equal(expansion_alloc(SMALL, &table, NULL), BP_OK);
	assert_int_equal(BASELINE_TUCKER.fit(&BASELINE_TUCKER, &material, &fitted, NULL), BP_OK);
	assert_int_equal(BASELINE_TUCKER.expand(fitted.state, &table, NULL), BP_OK);
	for (uint32_t i = 0; i < SMALL.theta_h; i++)
		for (uint32_t k = 0; k < SMALL.phi_d; k++) {
			size_t cell = lattice_index(SMALL, i, 7, k);
			double expected = exp(logarithm(i, 7, k, 1));
			if (!(fabs(table.unit * (double)table.rgb[1][cell] + LOG_OFFSET - expected) <= 1e-3 * expected))
				fail_msg("cell %zu: %g, expected %g", cell, (double)table.rgb[1][cell], expected);
		}
	BASELINE_TUCKER.free_state(fitted.state);
	expansion_free(&table);
	lattice_free(&lattice);
}

static void an_evaluation_at_a_centre_gives_the_tables_value(void **unused)
{
	/* the centre of cell (12, 6, 8) of 24, 20, 32 */
	const double h = 12.5 * 12.5 / (24 * 24) * M_PI_2, d = 6.5 / 20 * M_PI_2, p = 8.5 / 32 * M_PI;
	const double a = sin(d) * cos(p), b = sin(d) * sin(p), c = cos(d);
	const double wi[3] = {cos(h) * a + sin(h) * c, b, cos(h) * c - sin(h) * a};
	const double wo[3] = {-cos(h) * a + sin(h) * c, -b, cos(h) * c + sin(h) * a};
	struct lattice lattice = make_table();
	const struct bench_material material = {.name = "two-terms", .lattice = &lattice, .budget_bytes = 4000};
	double rgb[3];
	struct fitted fitted;
	(void)unused;

	assert_int_equal(BASELINE_TUCKER.fit(&BASELINE_TUCKER, &material, &fitted, NULL), BP_OK);
	BASELINE_TUCKER.evaluate(fitted.state, wi, wo, rgb);
	for (int q = 0; q < 3; q++) {
		double expected = lattice.rgb[q][lattice_index(SMALL, 12, 6, 8)];
		if (!(fabs(rgb[q] - expected) <= 2e-3 * expected))
			fail_msg("channel %d: %g, expected %g", q, rgb[q], expected);
	}
	BASELINE_TUCKER.free_state(fitted.state);
	lattice_free(&lattice);
}

static void the_size_follows_the_budget(void **unused)
{
	struct lattice lattice = make_table();
	struct bench_material material = {.name = "noise", .lattice = &lattice};
	uint32_t random = 1;
	(void)unused;

	for (size_t cell = 0; cell < lattice_cells(SMALL); cell++) { /* of full rank, so that no term is spared */
		random = random * 1664525 + 1013904223;
		lattice.rgb[0][cell] *= 0.5 + random / 4294967296.0;
	}
	for (size_t budget = 1000; budget <= 8000; budget *= 2) {
		size_t term = (24 + 20 + 32 + 3) * 4;
		struct fitted fitted;
		material.budget_bytes = budget;
		assert_int_equal(BASELINE_TUCKER.fit(&BASELINE_TUCKER, &material, &fitted, NULL), BP_OK);
		assert_int_equal(fitted.bytes, budget / term * term);
		BASELINE_TUCKER.free_state(fitted.state);
	}
	lattice_free(&lattice);
}

static void a_hole_takes_the_nearest_value_along_theta_d(void **unused)
{
	struct lattice lattice;
	uint32_t *source;
	(void)unused;

	assert_int_equal(lattice_alloc(SMALL, &lattice, NULL), BP_OK);
	source = malloc(lattice_cells(SMALL) * sizeof *source);
	assert_non_null(source);
	assert_int_equal(lattice_fill_sources(&lattice, source, NULL), BP_ERROR_BAD_INPUT);
	lattice.valid[lattice_index(SMALL, 3, 5, 7)] = 1;
	lattice.valid[lattice_index(SMALL, 3, 9, 7)] = 1;
	assert_int_equal(lattice_fill_sources(&lattice, source, NULL), BP_OK);
	assert_int_equal(source[lattice_index(SMALL, 3, 0, 7)], lattice_index(SMALL, 3, 5, 7));
	assert_int_equal(source[lattice_index(SMALL, 3, 8, 7)], lattice_index(SMALL, 3, 5, 7));
	assert_int_equal(source[lattice_index(SMALL, 3, 15, 7)], lattice_index(SMALL, 3, 9, 7));
	assert_int_equal(source[lattice_index(SMALL, 20, 15, 0)], lattice_index(SMALL, 3, 9, 7));
	free(source);
	lattice_free(&lattice);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_tensor_of_two_terms_is_recovered),
		cmocka_unit_test(the_table_comes_back_and_holes_are_ignored),
		cmocka_unit_test(an_evaluation_at_a_centre_gives_the_tables_value),
		cmocka_unit_test(the_size_follows_the_budget),
		cmocka_unit_test(a_hole_takes_the_nearest_value_along_theta_d),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
