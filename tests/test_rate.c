/* rate.h: what a step is said to cost is what counting tells, and near what coding takes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "codec/spectral/planes.h"
#include "codec/spectral/rate.h"

static const struct lattice_dims DIMS = {40, 36, 48};
static const double ROUND = 0.3;

/* Coefficients that fall off with the harmonic, the row and the column, as a material's do, with signs and a spread by a fixed sequence. */
static int model_make(void **state)
{
	const size_t cells = lattice_cells(DIMS);
	struct spectral_model *model = calloc(1, sizeof *model);
	uint64_t seed = 11;

	model->coefficient[0] = malloc(3 * cells * sizeof(float));
	for (size_t i = 0; i < 3 * cells; i++) {
		const size_t lane = i % DIMS.phi_d, column = i / DIMS.phi_d % DIMS.theta_d,
					 row = i / DIMS.phi_d / DIMS.theta_d % DIMS.theta_h;
		const double fall =
			40 / (1 + 0.02 * (double)(lane * lane) + 0.05 * (double)(row * row) + 0.05 * (double)(column * column));
		seed = seed * 6364136223846793005u + 1442695040888963407u;
		const double spread = (double)(int32_t)(seed >> 32) * 0x1p-31;
		model->coefficient[0][i] = (float)(fall * spread * spread * spread);
	}
	model->coefficient[1] = model->coefficient[0] + cells;
	model->coefficient[2] = model->coefficient[1] + cells;
	*state = model;
	return 0;
}

static int model_drop(void **state)
{
	struct spectral_model *model = *state;
	free(model->coefficient[0]);
	free(model);
	return 0;
}

static void bits_are_those_that_counting_tells(void **state)
{
	const struct spectral_model *model = *state;
	static struct rate rate;
	float largest = 0;

	rate_measure(model, DIMS, &rate);
	for (size_t i = 0; i < 3 * lattice_cells(DIMS); i++)
		largest = fmaxf(largest, fabsf(model->coefficient[0][i]));
	assert_true(rate.largest == largest);
	for (double step = 0.01; step < 3; step *= 1.7)
		for (uint32_t plane = 0; plane < 3; plane++) {
			double bits = 0;
			for (size_t i = 0; i < 3 * lattice_cells(DIMS); i++) {
				const uint32_t level = (uint32_t)(fabs((double)model->coefficient[0][i]) / step + ROUND) >> plane;
				bits += level ? 3.5 + (31 - __builtin_clz(level)) : 0;
			}
			/* A third of the rows has been looked at, in bins of a sixteenth of an octave. */
			assert_true(fabs(rate_bits(&rate, step, ROUND, plane) - bits) < 0.05 * bits + 200);
		}
}

static void the_step_for_some_bits_takes_them(void **state)
{
	static struct rate rate;
	rate_measure(*state, DIMS, &rate);
	for (double bits = 500; bits < 1e6; bits *= 3)
		assert_true(fabs(rate_bits(&rate, rate_step(&rate, bits, ROUND, 1e-6), ROUND, 0) - bits) < 0.01 * bits);
	assert_true(rate_step(&rate, 1e12, ROUND, 1e-3) == 1e-3);
	/* No bits: the step that makes every level 0. */
	assert_true(rate_bits(&rate, rate_step(&rate, 0, ROUND, 1e-6), ROUND, 0) == 0);
}

static void the_bytes_of_all_planes_are_foreseen_before_the_lowest(void **state)
{
	struct spectral_model *model = *state;
	static struct rate rate;
	struct planes *planes;

	rate_measure(model, DIMS, &rate);
	assert_int_equal(planes_create(DIMS, 1, &planes, NULL), BP_OK);
	for (float step = 0.02f; step < 0.3f; step *= 2) {
		struct byte_buffer bytes = {0};
		struct range_encoder encoder;
		struct mixed_coder coder = {.encoder = &encoder, .tables = mixer_tables_get()};
		double taken[RATE_PLANES] = {0};
		float centre[3];
		assert_int_equal(planes_quantise(planes, model->coefficient, step, NULL), BP_OK);
		planes_start(planes, planes_settle(planes, centre));
		range_encoder_start(&encoder, &bytes);
		for (uint32_t unit = 0; unit < planes_units(planes); unit++) {
			const uint32_t plane = planes_unit_plane(planes, unit);
			planes_encode_unit(planes, &coder, unit);
			if (plane < RATE_PLANES)
				taken[plane] = (double)range_encoder_bytes(&encoder);
		}
		assert_true(fabs(rate_foresee(&rate, (double)step, ROUND, taken) / taken[0] - 1) < 0.08);
		byte_buffer_free(&bytes);
	}
	planes_free(planes);
}

static void a_table_of_zeros_costs_nothing(void **unused)
{
	float *zeros = calloc(3 * lattice_cells(DIMS), sizeof *zeros);
	const struct spectral_model model = {.coefficient = {zeros, zeros, zeros}};
	static struct rate rate;
	(void)unused;
	rate_measure(&model, DIMS, &rate);
	assert_true(rate.largest == 0);
	assert_true(rate_bits(&rate, 0x1p-22, ROUND, 0) == 0);
	assert_true(rate_step(&rate, 1000, ROUND, 0x1p-22) == 0x1p-22);
	free(zeros);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(bits_are_those_that_counting_tells, model_make, model_drop),
		cmocka_unit_test_setup_teardown(the_step_for_some_bits_takes_them, model_make, model_drop),
		cmocka_unit_test_setup_teardown(the_bytes_of_all_planes_are_foreseen_before_the_lowest, model_make, model_drop),
		cmocka_unit_test(a_table_of_zeros_costs_nothing),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
