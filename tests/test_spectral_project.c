/* spectral_project.c: invalid cells get values that fewer coefficients tell, and valid cells stay. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/spectral/spectral.h"
#include "model/spectral/spectrum.h"

static const struct lattice_dims DIMS = {32, 30, 24};

/* Smooth in all three angles; another in each channel. */
static float truth_at(int channel, size_t i)
{
	const double k = (double)(i % DIMS.phi_d), j = (double)(i / DIMS.phi_d % DIMS.theta_d),
				 h = (double)(i / DIMS.phi_d / DIMS.theta_d);
	return (float)(2 * cos(0.11 * h + 0.2 * channel) * cos(0.07 * j) +
	               0.5 * cos(3.14159265 * 2 * (k + 0.5) / DIMS.phi_d) * sin(0.1 * j + 0.05 * h));
}

static int by_size(const void *a, const void *b)
{
	const float x = fabsf(*(const float *)a), y = fabsf(*(const float *)b);
	return x < y ? 1 : x > y ? -1 : 0;
}

static const struct spectral_weights EVEN; /* all 0 */

/* Checks that valid cells are what they were; the root of the energy in all but the `kept` largest coefficients. Uses up the table. */
static double rest_of(struct spectrum *spectrum, float *const table[3], const uint8_t *valid, const float base[3], size_t kept)
{
	const size_t cells = lattice_cells(DIMS);
	double sum = 0;
	for (int c = 0; c < 3; c++) {
		for (size_t i = 0; i < cells; i++)
			assert_true(!valid[i] || table[c][i] == truth_at(c, i));
		spectrum_forward(spectrum, table[c], base[c]);
		qsort(table[c], cells, sizeof(float), by_size);
		for (size_t i = kept; i < cells; i++)
			sum += (double)table[c][i] * (double)table[c][i];
	}
	return sqrt(sum);
}

static void what_a_record_cannot_hold_becomes_less_and_valid_cells_stay(void **unused)
{
	const size_t cells = lattice_cells(DIMS);
	float *block = malloc(3 * cells * sizeof *block), *const table[3] = {block, block + cells, block + 2 * cells};
	const float base[3] = {0.1f, 0, -0.1f};
	uint8_t *valid = malloc(cells);
	struct spectrum *spectrum = NULL;
	double rest[4];
	(void)unused;

	assert_int_equal(spectrum_create(DIMS, SPAN_MARGIN, &spectrum, NULL), BP_OK);
	for (int steps = 0; steps < 4; steps++) {
		for (size_t i = 0; i < cells; i++)
			valid[i] = i / DIMS.phi_d % DIMS.theta_d < 24 && i % 7 != 3;
		for (int c = 0; c < 3; c++)
			for (size_t i = 0; i < cells; i++)
				table[c][i] = truth_at(c, i);
		assert_int_equal(spectral_fill(DIMS, valid, table, NULL, NULL, NULL), BP_OK);
		assert_int_equal(spectral_project(spectrum, DIMS, valid, base, &EVEN, SPAN_MARGIN, 1500, steps, table, NULL), BP_OK);
		rest[steps] = rest_of(spectrum, table, valid, base, 600);
	}
	assert_true(rest[1] < 0.9 * rest[0]);
	assert_true(rest[2] < rest[1] && rest[3] < rest[2]);
	spectrum_free(spectrum);
	free(valid);
	free(block);
}

/* A table that is made while it is filled, as far as it is asked for. */
struct making {
	float *const *table;
	size_t done[3];
};

static void making_ready(void *user, int channel, size_t end)
{
	struct making *making = user;
	assert_true(end > 0 && end <= lattice_cells(DIMS));
	for (; making->done[channel] < end; making->done[channel]++)
		making->table[channel][making->done[channel]] = truth_at(channel, making->done[channel]);
}

/* The first slices, and the last, have no valid cell. */
static void a_table_made_while_it_is_filled_becomes_what_one_made_before_does(void **unused)
{
	const size_t cells = lattice_cells(DIMS), slice = DIMS.theta_d * DIMS.phi_d;
	float *block = calloc(6 * cells, sizeof *block), *const table[3] = {block, block + cells, block + 2 * cells};
	float *const made[3] = {block + 3 * cells, block + 4 * cells, block + 5 * cells};
	struct making making = {.table = made};
	uint8_t *valid = malloc(cells);
	(void)unused;

	for (size_t i = 0; i < cells; i++) {
		valid[i] = i / slice > 2 && i / slice + 1 < DIMS.theta_h && i % 5 != 2;
		for (int c = 0; c < 3; c++)
			table[c][i] = truth_at(c, i);
	}
	assert_int_equal(spectral_fill(DIMS, valid, table, NULL, NULL, NULL), BP_OK);
	assert_int_equal(spectral_fill(DIMS, valid, made, making_ready, &making, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		assert_int_equal(making.done[c], cells);
	assert_memory_equal(block, made[0], 3 * cells * sizeof *block);
	free(valid);
	free(block);
}

static void a_table_without_a_hole_is_left_alone(void **unused)
{
	const size_t cells = lattice_cells(DIMS);
	float *block = malloc(3 * cells * sizeof *block), *const table[3] = {block, block + cells, block + 2 * cells};
	const float base[3] = {0, 0, 0};
	uint8_t *valid = malloc(cells);
	struct spectrum *spectrum = NULL;
	(void)unused;

	assert_int_equal(spectrum_create(DIMS, SPAN_MARGIN, &spectrum, NULL), BP_OK);
	memset(valid, 1, cells);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < cells; i++)
			table[c][i] = truth_at(c, i);
	assert_int_equal(spectral_project(spectrum, DIMS, valid, base, &EVEN, SPAN_MARGIN, 60400, 2, table, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < cells; i++)
			assert_true(table[c][i] == truth_at(c, i));
	spectrum_free(spectrum);
	free(valid);
	free(block);
}

/* Four each of 1, 2, 4, ... 32, with either sign: the size is a bin's end, right above the largest that there is no room for. */
static void the_size_of_a_rank_leaves_as_many_above(void **unused)
{
	static const struct {
		size_t every;
		double count;
		float size;
	} RANKS[] = {{1, 3, 34},
	             {1, 4, 17},
	             {1, 8, 8.5f},
	             {1, 11, 8.5f},
	             {1, 12, 4.25f},
	             /* Rows 1 and 4 of the six, of 2 and 16, stand for three each. */
	             {3, 11, 17},
	             {3, 12, 2.125f},
	             {3, 23, 2.125f}};
	float coefficient[6 * 4];
	(void)unused;
	for (int n = 0; n < 24; n++)
		coefficient[n] = (float)(n % 2 ? -1 : 1) * ldexpf(1, n / 4);
	for (size_t n = 0; n < sizeof RANKS / sizeof *RANKS; n++)
		assert_true(spectral_size_of_rank(coefficient, 6, 4, RANKS[n].every, RANKS[n].count) == RANKS[n].size);
	assert_true(spectral_places(4.3) == 8);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_size_of_a_rank_leaves_as_many_above),
		cmocka_unit_test(what_a_record_cannot_hold_becomes_less_and_valid_cells_stay),
		cmocka_unit_test(a_table_made_while_it_is_filled_becomes_what_one_made_before_does),
		cmocka_unit_test(a_table_without_a_hole_is_left_alone),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
