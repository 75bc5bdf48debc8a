/* spectral_denoise.c: noise goes, what stands out of it stays, and a table without noise is left alone. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/spectral/spectral.h"

static const struct lattice_dims DIMS = {40, 40, 36};
enum { CELLS = 40 * 40 * 36, SEEN = 34 }; /* columns of theta_d before it grazes */

/* About normal: the sum of twelve uniform numbers. */
static double normal(void)
{
	static uint64_t state = 5;
	double sum = -6;
	for (int n = 0; n < 12; n++) {
		state = state * 6364136223846793005u + 1442695040888963407u;
		sum += (double)(state >> 11) * 0x1p-53;
	}
	return sum;
}

/* The standard deviation that noise_add has given to a value of theta_d. */
static double white(uint32_t j) { return j < SEEN ? 0.03 : 0.15; }

/* White noise that grows towards grazing angles, and streaks along phi_d that do not. */
static void noise_add(double streaks, float *table)
{
	for (uint32_t r = 0; r < DIMS.theta_h * DIMS.theta_d; r++) {
		const double streak = streaks * normal();
		for (uint32_t k = 0; k < DIMS.phi_d; k++)
			table[r * DIMS.phi_d + k] += (float)(streak + white(r % DIMS.theta_d) * normal());
	}
}

/* Spectra of three tables: of the first as it is, of the others without anything. */
static void fields_of(struct spectrum *spectrum, const float *table, float *const field[3])
{
	memcpy(field[0], table, CELLS * sizeof *table);
	spectrum_forward(spectrum, field[0], 0);
	memset(field[1], 0, CELLS * sizeof *table);
	memset(field[2], 0, CELLS * sizeof *table);
}

struct fixture {
	struct spectrum *spectrum;
	float *table, *field[3], *clean;
};

static int fixture_make(void **state)
{
	static struct fixture f;
	assert_int_equal(spectrum_create(DIMS, 0, &f.spectrum, NULL), BP_OK);
	f.table = calloc(5 * CELLS, sizeof *f.table);
	assert_non_null(f.table);
	f.clean = f.table + CELLS;
	for (int c = 0; c < 3; c++)
		f.field[c] = f.table + (size_t)(2 + c) * CELLS;
	*state = &f;
	return 0;
}

static int fixture_free(void **state)
{
	struct fixture *f = *state;
	spectrum_free(f->spectrum);
	free(f->table);
	return 0;
}

static double energy(const float *x, const float *less)
{
	double sum = 0;
	for (size_t n = 0; n < CELLS; n++)
		sum += ((double)x[n] - (double)less[n]) * ((double)x[n] - (double)less[n]);
	return sum;
}

/* A slope along theta_h that is steep at first, as that of a lobe. */
static void a_lobe_comes_out_of_the_noise(void **state)
{
	struct fixture *f = *state;
	float level;
	for (uint32_t r = 0; r < DIMS.theta_h * DIMS.theta_d; r++)
		for (uint32_t k = 0; k < DIMS.phi_d; k++)
			f->table[r * DIMS.phi_d + k] = (float)(8 * exp(-0.1 * (r / DIMS.theta_d)));
	fields_of(f->spectrum, f->table, f->field);
	memcpy(f->clean, f->field[0], CELLS * sizeof(float));
	noise_add(0, f->table);
	fields_of(f->spectrum, f->table, f->field);
	const double before = energy(f->field[0], f->clean);
	assert_int_equal(spectral_denoise(f->spectrum, DIMS, NULL, f->field, &level, NULL), BP_OK);
	assert_true(energy(f->field[0], f->clean) < 0.075 * before); /* 0.06; without the turned table 0.09 */
	assert_true(level > 0.025f && level < 0.04f);                /* that of all columns but the grazing ones */
}

/* Streaks of 0.1 in all columns are not five times as strong where white noise is: what is above them there is kept. */
static void streaks_do_not_grow_with_white_noise(void **state)
{
	struct fixture *f = *state;
	double found = 0, wanted = 0;
	float level;
	memset(f->table, 0, CELLS * sizeof(float));
	for (uint32_t i = 10; i < 20; i++)
		for (uint32_t j = SEEN; j < DIMS.theta_d; j++)
			for (uint32_t k = 0; k < DIMS.phi_d; k++)
				f->table[(i * DIMS.theta_d + j) * DIMS.phi_d + k] = i % 2 ? 0.3f : -0.3f;
	fields_of(f->spectrum, f->table, f->field);
	memcpy(f->clean, f->field[0], CELLS * sizeof(float));
	noise_add(0.1, f->table);
	fields_of(f->spectrum, f->table, f->field);
	assert_int_equal(spectral_denoise(f->spectrum, DIMS, NULL, f->field, &level, NULL), BP_OK);
	for (size_t n = 0; n < CELLS; n++) {
		found += (double)f->field[0][n] * (double)f->clean[n];
		wanted += (double)f->clean[n] * (double)f->clean[n];
	}
	assert_true(found > 0.8 * wanted);
}

static void a_table_without_noise_is_left_alone(void **state)
{
	struct fixture *f = *state;
	float level = 1;
	for (uint32_t n = 0; n < CELLS; n++)
		f->table[n] = (float)(n / DIMS.phi_d % DIMS.theta_d) + 0.001f * (float)normal();
	fields_of(f->spectrum, f->table, f->field);
	memcpy(f->clean, f->field[0], CELLS * sizeof(float));
	assert_int_equal(spectral_denoise(f->spectrum, DIMS, NULL, f->field, &level, NULL), BP_OK);
	assert_true(level == 0);
	assert_memory_equal(f->field[0], f->clean, CELLS * sizeof(float));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(a_lobe_comes_out_of_the_noise, fixture_make, fixture_free),
		cmocka_unit_test_setup_teardown(streaks_do_not_grow_with_white_noise, fixture_make, fixture_free),
		cmocka_unit_test_setup_teardown(a_table_without_noise_is_left_alone, fixture_make, fixture_free),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
