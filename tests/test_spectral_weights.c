/* spectral_weights.h and weights_code.h: factors by their formulas, weights as bytes and back. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "codec/spectral/weights_code.h"
#include "model/spectral/spectral.h"

static void near(double found, double wanted, double most) { assert_true(fabs(found - wanted) <= most); }

/* A few rows of a plane of 90 x 90: 45, 23 and 12 coarse ones. */
static void details_and_high_harmonics_have_coarser_steps(void **state)
{
	static const struct {
		uint32_t row, column;
		double octaves;
	} PLACES[] = {{0, 0, 0}, {0, 50, 9 / 16.0}, {50, 0, 9 / 16.0}, {50, 89, 18 / 16.0}, {0, 30, 3 / 16.0}, {13, 13, 2 / 16.0}};
	const struct lattice_dims d = {90, 90, 180};
	struct spectral_weights weights = {.graded = true};
	struct spectral_factors factors;
	(void)state;
	assert_int_equal(spectral_factors_create(d, &weights, &factors, NULL), BP_OK);
	for (size_t n = 0; n < sizeof PLACES / sizeof *PLACES; n++)
		near(factors.row[PLACES[n].row * 90 + PLACES[n].column], exp2(PLACES[n].octaves), 1e-6);
	for (uint32_t m = 0; m < 180; m++)
		near(factors.harmonic[m], sqrt(3 / (2 + cos(M_PI * m / 180))), 1e-6);
	free(factors.row);
	memset(weights.weight, 5, sizeof weights.weight);
	assert_int_equal(spectral_factors_create(d, &weights, &factors, NULL), BP_OK);
	near(factors.row[0], exp2(2.5), 1e-5);
	free(factors.row);
	weights.graded = false;
	assert_int_equal(spectral_factors_create(d, &weights, &factors, NULL), BP_OK);
	near(factors.row[50 * 90 + 50], exp2(5 / 16.0), 1e-6);
	assert_true(factors.harmonic[179] == 1);
	free(factors.row);
}

/* Shares of 0, 0, a half, five sixths, 1 and 1 of weights 7 and 40. */
static void noise_eases_weights(void **state)
{
	static const struct {
		float octaves;
		uint8_t seven, forty;
	} EASED[] = {{-3, 0, 0}, {0.5f, 0, 0}, {2, 4, 20}, {3, 6, 33}, {3.5f, 7, 40}, {20, 7, 40}};
	(void)state;
	for (size_t n = 0; n < sizeof EASED / sizeof *EASED; n++) {
		struct spectral_weights weights = {.graded = true, .weight = {7, 40}};
		spectral_weights_ease(&weights, EASED[n].octaves);
		assert_int_equal(weights.weight[0], EASED[n].seven);
		assert_int_equal(weights.weight[1], EASED[n].forty);
		assert_int_equal(weights.weight[2], 0);
	}
}

static void weights_come_back(void **state)
{
	(void)state;
	for (uint32_t n = 0; n < 40; n++) {
		struct spectral_weights weights = {.graded = n % 4 != 0}, back = {.graded = n % 4 != 0};
		struct byte_buffer bytes = {0};
		const uint32_t count = weights.graded ? SPECTRAL_WEIGHTS : 100;
		srand(n);
		for (uint32_t k = 0; k < count; k++)
			weights.weight[k] = (uint8_t)(n < 20 ? (unsigned)rand() % (SPECTRAL_WEIGHT_MOST + 1) : k / 18 / 3 + k % 18 / 4);
		weights_encode(&weights, &bytes);
		assert_null(weights_decode(bytes.bytes, bytes.count, &back));
		assert_memory_equal(weights.weight, back.weight, count);
		assert_true(!weights.graded || n < 20 || bytes.count < 60);
		assert_non_null(weights_decode(bytes.bytes, bytes.count - 1, &back));
		byte_buffer_free(&bytes);
	}
}

static void a_weight_beyond_the_largest_is_refused(void **state)
{
	(void)state;
	for (uint32_t n = 0; n < SPECTRAL_WEIGHTS; n += 17)
		for (uint8_t most = SPECTRAL_WEIGHT_MOST; most <= SPECTRAL_WEIGHT_MOST + 1; most++) {
			struct spectral_weights weights = {.graded = true}, back = {.graded = true};
			struct byte_buffer bytes = {0};
			weights.weight[n] = most;
			weights_encode(&weights, &bytes);
			const char *fault = weights_decode(bytes.bytes, bytes.count, &back);
			assert_true((fault != NULL) == (most > SPECTRAL_WEIGHT_MOST));
			assert_true(!fault || strstr(fault, "from 0 to 63"));
			byte_buffer_free(&bytes);
		}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(details_and_high_harmonics_have_coarser_steps),
		cmocka_unit_test(noise_eases_weights),
		cmocka_unit_test(weights_come_back),
		cmocka_unit_test(a_weight_beyond_the_largest_is_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
