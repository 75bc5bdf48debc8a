/* trellis.h and dependent.h: the levels chosen are the best there are, and stand for what the model makes of them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "codec/spectral/trellis.h"
#include "model/spectral/spectral.h"

static uint64_t seed = 3;
static uint32_t random_below(uint32_t n)
{
	seed = seed * 6364136223846793005u + 1442695040888963407u;
	return (uint32_t)((seed >> 32) * n >> 32);
}

/* The quantisers that levels are of, by the table of FORMAT.md, worked out by hand: from state 0, odd levels go 0, 1, 5, 2, 0. */
static void states_move_by_the_parity_of_levels(void **unused)
{
	static const uint32_t SIZES[] = {1, 1, 3, 5, 2, 1, 2, 7, 4}, STATE[] = {0, 1, 5, 2, 0, 0, 1, 4, 7};
	uint32_t state = 0;
	(void)unused;
	for (size_t n = 0; n < sizeof SIZES / sizeof *SIZES; n++) {
		assert_int_equal(state, STATE[n]);
		assert_int_equal(dependent_quantiser(state), STATE[n] > 3);
		state = dependent_next(state, SIZES[n]);
	}
	/* Two ways lead to each state, by one parity each, and from states of one quantiser. */
	for (uint32_t to = 0; to < DEPENDENT_STATES; to++) {
		uint32_t ways[2] = {0}, quantisers = 0;
		for (uint32_t from = 0; from < DEPENDENT_STATES; from++)
			for (uint32_t parity = 0; parity < 2; parity++)
				if (dependent_next(from, parity) == to) {
					ways[parity]++;
					quantisers |= 1u << dependent_quantiser(from);
				}
		assert_true(ways[0] == 1 && ways[1] == 1 && quantisers != 3);
	}
}

static struct trellis_cell cell_of(float size, uint8_t around)
{
	const uint32_t level = (uint32_t)(size + 0.4f);
	return (struct trellis_cell){.level = level, .beyond = size - (float)level, .around = around};
}

static double value_of(uint32_t level, uint32_t quantiser)
{
	const struct spectral_model model = {.step = 1, .dependent = true, .centre = {0.055f, 0.2f, 0.055f, 0.4f}};
	return (double)spectral_level_value(&model, (int32_t)level, 0, quantiser);
}

/* Squared errors alone, where bits cost the same: what is around is much, so a step more is cheap. */
static double error_of(const float *size, const struct trellis_cell *cells, uint32_t count)
{
	double sum = 0;
	uint32_t state = 0;
	for (uint32_t i = 0; i < count; i++) {
		const double apart = (double)size[i] - value_of(cells[i].level, dependent_quantiser(state));
		sum += apart * apart;
		if (cells[i].level) {
			assert_int_equal(cells[i].quantiser, dependent_quantiser(state));
			state = dependent_next(state, cells[i].level);
		}
	}
	return sum;
}

/* Every way through a few large sizes, tried one by one: none has less error and bits by the rule of the classes' last one. */
static void no_other_way_costs_less(void **unused)
{
	enum { COUNT = 6 };
	uint8_t class_of[TRELLIS_SUMS];
	(void)unused;
	trellis_classes(class_of);
	for (int trial = 0; trial < 50; trial++) {
		struct trellis_cell cells[COUNT], other[COUNT];
		struct trellis_costs costs[COUNT];
		float size[COUNT];
		double best = INFINITY, chosen = 0;
		uint32_t first[COUNT];
		for (int i = 0; i < COUNT; i++) {
			size[i] = 10 + (float)random_below(5000) / 1000;
			cells[i] = cell_of(size[i], class_of[255]);
			first[i] = cells[i].level;
		}
		memcpy(other, cells, sizeof cells);
		trellis_choose(cells, COUNT, costs);
		/* Bits of a step more where so much is around: 0.12. */
		for (int i = 0; i < COUNT; i++)
			chosen += 0.09 * 0.12 * ((double)cells[i].level - first[i]);
		chosen += error_of(size, cells, COUNT);
		for (uint32_t way = 0; way < 4096; way++) { /* -1 to 2 from each level */
			double cost = 0;
			uint32_t state = 0;
			for (int i = 0; i < COUNT; i++) {
				const uint32_t level = first[i] - 1 + (way >> 2 * i & 3);
				const double apart = (double)size[i] - value_of(level, dependent_quantiser(state));
				cost += apart * apart + 0.09 * 0.12 * ((double)level - first[i]);
				state = dependent_next(state, level);
			}
			best = cost < best ? cost : best;
		}
		assert_true(fabs(chosen - best) < 1e-4);
	}
}

/* Of sizes that lie anywhere, one quantiser of this step leaves 1/12 in the mean square. */
static void errors_are_less_than_those_of_one_quantiser(void **unused)
{
	enum { COUNT = 4000 };
	static struct trellis_cell cells[COUNT];
	static struct trellis_costs costs[COUNT];
	static float size[COUNT];
	uint8_t class_of[TRELLIS_SUMS];
	(void)unused;
	trellis_classes(class_of);
	for (int i = 0; i < COUNT; i++) {
		size[i] = 100 + (float)random_below(100000) / 100;
		cells[i] = cell_of(size[i], class_of[255]);
	}
	trellis_choose(cells, COUNT, costs);
	/* 1.0 dB and more below 1/12; 1/48 would be a quantiser of half the step, which takes a bit more. */
	assert_true(error_of(size, cells, COUNT) / COUNT < 1 / 12.0 / 1.26);
	assert_true(error_of(size, cells, COUNT) / COUNT > 1 / 48.0);
	for (int i = 0; i < COUNT; i++)
		assert_true(fabsf(cells[i].beyond) < 1.1f);
}

/* By hand: nothing around, 1.0 costs (1 - 0.055)^2 + 0.09 x 9.15 = 0.83 less than 1; 0.9 costs 0.84 and more than 0.81. */
static void one_alone_stays_if_it_is_worth_its_place(void **unused)
{
	struct trellis_cell cell;
	struct trellis_costs costs;
	uint8_t class_of[TRELLIS_SUMS];
	(void)unused;
	trellis_classes(class_of);
	cell = cell_of(1.0f, class_of[0]);
	trellis_choose(&cell, 1, &costs);
	assert_int_equal(cell.level, 1);
	cell = cell_of(0.9f, class_of[0]);
	trellis_choose(&cell, 1, &costs);
	assert_int_equal(cell.level, 0);
	cell = cell_of(0.75f, class_of[9]);
	trellis_choose(&cell, 1, &costs);
	assert_int_equal(cell.level, 1);
	/* The classes: sums up to 6 by themselves, then wider. */
	assert_true(class_of[0] == 0 && class_of[6] == 6 && class_of[7] == 7 && class_of[8] == 7 && class_of[9] == 8 &&
	            class_of[255] == 18);
	trellis_choose(NULL, 0, NULL);
}

/* Missing planes leave the quantiser open: a quarter of a step less, in the middle of both. */
static void values_are_those_of_the_format(void **unused)
{
	struct spectral_model model = {.step = 2, .dependent = true, .centre = {0.0625f, 0.25f, 0.125f, 0.5f}};
	(void)unused;
	assert_true(spectral_level_value(&model, 1, 0, 0) == 2.125f);
	assert_true(spectral_level_value(&model, -1, 0, 1) == -1.5f);
	assert_true(spectral_level_value(&model, 3, 0, 0) == 6.25f);
	assert_true(spectral_level_value(&model, -3, 0, 1) == -5.25f);
	assert_true(spectral_level_value(&model, 7, 2, 0) == 2 * (4 + 2 - 0.25f));
	assert_true(spectral_level_value(&model, 3, 2, 0) == 0);
	model.dependent = false;
	assert_true(spectral_level_value(&model, 7, 2, 0) == 12);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(states_move_by_the_parity_of_levels),
		cmocka_unit_test(no_other_way_costs_less),
		cmocka_unit_test(errors_are_less_than_those_of_one_quantiser),
		cmocka_unit_test(one_alone_stays_if_it_is_worth_its_place),
		cmocka_unit_test(values_are_those_of_the_format),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
