#include "trellis.h"

#include <stddef.h>
#include <string.h>

#include "clones.h"

enum { CLASSES = 19 };
static const float NEVER = 1e30f;

/*
 * By the sum around: the least of each class, and bits of 0, of 1, and of each further step, as sizes around which the mean is
 * such are distributed: geometrically, 0.15 bits for a sign that is not worth its bit, and dear where nothing is around
 * (measured on four materials).
 */
static const uint8_t LEAST[CLASSES] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 11, 13, 16, 20, 25, 32, 44, 64, 100, 160};
static const float ZERO[CLASSES] = {0.00f, 0.01f, 0.02f, 0.06f, 0.13f, 0.20f, 0.28f, 0.39f, 0.54f, 0.65f,
                                    0.79f, 0.96f, 1.14f, 1.38f, 1.64f, 2.06f, 2.48f, 3.13f, 3.63f};
static const float ONE[CLASSES] = {9.15f, 8.13f, 6.16f, 4.75f, 3.86f, 3.29f, 2.93f, 2.62f, 2.37f, 2.27f,
                                   2.19f, 2.15f, 2.16f, 2.23f, 2.35f, 2.61f, 2.91f, 3.46f, 3.91f};
static const float MORE[CLASSES] = {9.00f, 7.97f, 5.99f, 4.54f, 3.59f, 2.94f, 2.49f, 2.08f, 1.69f, 1.47f,
                                    1.24f, 1.04f, 0.87f, 0.70f, 0.56f, 0.39f, 0.29f, 0.17f, 0.12f};

/* Where values lie beyond their level, before the record's own centres are known. */
static const float CENTRE = 0.055f, CENTRE_SECOND_ONE = 0.2f;

void trellis_classes(uint8_t class_of[TRELLIS_SUMS])
{
	uint32_t class = 0;
	for (uint32_t sum = 0; sum < TRELLIS_SUMS; sum++) {
		class += class + 1 < CLASSES && sum >= LEAST[class + 1];
		class_of[sum] = (uint8_t) class;
	}
}

/* Of the two levels worth a look in a quantiser, one even and one odd, the lower one. */
static ALWAYS_INLINE uint32_t lower_level(const struct trellis_cell *cell, uint32_t quantiser)
{
	if (quantiser)
		return cell->level + (cell->beyond >= 0.5f + CENTRE);
	return cell->level - (cell->level > 0 && cell->beyond < CENTRE);
}

typedef float lanes4 __attribute__((vector_size(16)));
typedef int32_t mask4 __attribute__((vector_size(16)));

static ALWAYS_INLINE lanes4 lanes_where(mask4 where, lanes4 a, lanes4 b)
{
	return (lanes4)(((mask4)a & where) | ((mask4)b & ~where));
}
static ALWAYS_INLINE lanes4 lanes_all(float x) { return (lanes4){x, x, x, x}; }

/*
 * What each choice costs: 0; an even and an odd level of the first quantiser, then of the second. Where the size is far from 0,
 * bits are counted from those of the size itself, so that sums stay small.
 */
static ALWAYS_INLINE lanes4 cell_costs(const struct trellis_cell *cell, float *zero)
{
	const int32_t low = (int32_t)lower_level(cell, 0), low_second = (int32_t)lower_level(cell, 1), own = (int32_t)cell->level;
	const mask4 level = {low + (low & 1), low + (~low & 1), low_second + (low_second & 1), low_second + (~low_second & 1)};
	const mask4 more = level - 1 - (own > 2 ? own : 0);
	const lanes4 centre = lanes_where((level == 1) & (mask4){0, 0, -1, -1}, lanes_all(CENTRE_SECOND_ONE), lanes_all(CENTRE));
	const lanes4 apart = __builtin_convertvector(own - level, lanes4) + (lanes4){0, 0, 0.5f, 0.5f} + cell->beyond - centre;
	const lanes4 bits = ONE[cell->around] + __builtin_convertvector(more, lanes4) * MORE[cell->around];
	const float size = (float)cell->level + cell->beyond;
	*zero = own > 2 ? NEVER : size * size + TRELLIS_BIT * ZERO[cell->around];
	return lanes_where(level == 0, lanes_all(NEVER), apart * apart + TRELLIS_BIT * bits);
}

/* The states before a level that is even, or odd, by the state behind it: dependent_next turned round. */
static const uint8_t BEFORE[2][DEPENDENT_STATES] = {{0, 2, 6, 5, 1, 3, 4, 7}, {2, 0, 5, 6, 3, 1, 7, 4}};

static ALWAYS_INLINE lanes4 least(lanes4 a, lanes4 b) { return lanes_where(a < b, a, b); }

/* Each state's least cost so far, from each state's before the cell. */
static ALWAYS_INLINE void states_step(lanes4 *first, lanes4 *second, lanes4 level, float zero)
{
	const lanes4 even = __builtin_shufflevector(level, level, 0, 0, 2, 2),
				 odd = __builtin_shufflevector(level, level, 1, 1, 3, 3);
	const lanes4 low = __builtin_shufflevector(*first, *second, 0, 2, 6, 5),
				 high = __builtin_shufflevector(*first, *second, 1, 3, 4, 7);
	const lanes4 low_odd = __builtin_shufflevector(low, low, 1, 0, 3, 2),
				 high_odd = __builtin_shufflevector(high, high, 1, 0, 3, 2);
	*first = least(least(low + even, low_odd + odd), *first + zero);
	*second = least(least(high + even, high_odd + odd), *second + zero);
}

/* The cell's choice on the best way to `state`; returns the state before it. */
static ALWAYS_INLINE uint32_t cell_choose(struct trellis_cell *cell, const struct trellis_costs *before, uint32_t state)
{
	uint32_t from = state, quantiser = 0, level = 0;
	float best = before->of[state] + before->zero;
	for (uint32_t parity = 0; parity < 2; parity++) {
		const uint32_t s = BEFORE[parity][state], q = dependent_quantiser(s);
		const float cost = before->of[s] + before->level[2 * q + parity];
		if (cost < best) {
			best = cost;
			from = s;
			quantiser = q;
			level = lower_level(cell, q);
			level += (level & 1) != parity;
		}
	}
	cell->beyond += (float)((int32_t)cell->level - (int32_t)level) + (quantiser ? 0.5f : 0);
	cell->level = level;
	cell->quantiser = (uint8_t)quantiser;
	return from;
}

AVX2_CLONE static void choose(struct trellis_cell *cells, uint32_t count, struct trellis_costs *costs)
{
	lanes4 first = {0, NEVER, NEVER, NEVER}, second = {NEVER, NEVER, NEVER, NEVER};
	uint32_t state = 0;

	for (uint32_t i = 0; i < count; i++) {
		const lanes4 level = cell_costs(&cells[i], &costs[i].zero);
		memcpy(costs[i].of, &first, sizeof first);
		memcpy(costs[i].of + DEPENDENT_STATES / 2, &second, sizeof second);
		memcpy(costs[i].level, &level, sizeof level);
		states_step(&first, &second, level, costs[i].zero);
	}
	float end[DEPENDENT_STATES];
	memcpy(end, &first, sizeof first);
	memcpy(end + DEPENDENT_STATES / 2, &second, sizeof second);
	for (uint32_t s = 1; s < DEPENDENT_STATES; s++)
		state = end[s] < end[state] ? s : state;
	for (uint32_t i = count; i-- > 0;)
		state = cell_choose(&cells[i], &costs[i], state);
}

void trellis_choose(struct trellis_cell *cells, uint32_t count, struct trellis_costs *costs) { choose(cells, count, costs); }
