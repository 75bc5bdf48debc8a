/*
 * planes_settle.c: which levels are coded, and what the coder must know of them as a whole.
 *
 * Thinning is a quantiser that knows what levels cost, cheaply: the limit below which a level of 1 is not worth its place falls
 * with the sum of the levels around it. (The limits were found on five surrogates; 0.19 dB at the same bytes, VARIANTS.md.)
 */
#include <stdlib.h>

#include "planes.h"

/* In 1/100 of a step, by the sum of what is around: 0, 1, ... */
enum { AROUND_MAX = 9 };
static const uint8_t LIMIT[AROUND_MAX + 1] = {110, 95, 85, 80, 75, 70, 70, 65, 65, 60};

/* The blocks that hold what is around a block's cells, but for their neighbours in the block. */
struct surroundings {
	const int32_t *own, *before2, *before, *after, *after2, *other[2];
};

static uint32_t around(const struct surroundings *s, int k)
{
	const int y = k / BLOCK_EDGE, x = k % BLOCK_EDGE;
	int sum = 2 * (abs(s->before2[k]) + abs(s->after2[k])) + abs(s->before[k]) + abs(s->after[k]) + abs(s->other[0][k]) +
	          abs(s->other[1][k]);

	for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < BLOCK_EDGE; v++)
		for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < BLOCK_EDGE; u++)
			sum += v == y && u == x ? 0 : abs(s->own[v * BLOCK_EDGE + u]);
	return sum < AROUND_MAX ? (uint32_t)sum : AROUND_MAX;
}

struct tally {
	double excess[2];
	uint64_t count[2];
	uint32_t largest;
};

/* Settles one block; returns the planes that it needs. */
static uint8_t block_settle(struct level_block *block, const struct surroundings *s, const int limit[AROUND_MAX + 1],
                            double rounding, struct tally *tally)
{
	uint32_t sizes = 0;
	for (int k = 0; k < BLOCK_CELLS; k++) {
		const uint32_t size = (uint32_t)abs(block->level[k]);
		if (size == 0)
			continue;
		if (size == 1 && block->over[k] < limit[0] && block->over[k] < limit[around(s, k)]) {
			block->level[k] = 0;
			continue;
		}
		tally->excess[size > 1] += (block->over[k] + 0.5) / 256 - rounding;
		tally->count[size > 1]++;
		sizes |= size;
	}
	tally->largest |= sizes;
	return sizes ? (uint8_t)(32 - __builtin_clz(sizes)) : 0;
}

uint32_t planes_settle(struct planes *p, float rounding, float centre[2])
{
	const ptrdiff_t next = (ptrdiff_t)p->bands.blocks;
	struct tally tally = {0};
	uint32_t planes = 0;
	int limit[AROUND_MAX + 1];

	for (int n = 0; n <= AROUND_MAX; n++)
		limit[n] = (int)(256 * ((double)LIMIT[n] / 100 - 1 + (double)rounding) + 0.5);
	for (uint32_t f = 0; f < 3; f++)
		for (uint32_t m = 0; m < p->dims.phi_d; m++)
			for (uint32_t b = 0; b < p->bands.count; b++) {
				const struct band *band = &p->bands.band[b];
				const size_t block0 = (size_t)(m + 2) * p->bands.blocks;
				uint8_t *own = &p->top[f][block0 + band->block_at - band->block_stride - 1];
				*own = 0;
				for (uint32_t y = 0; y < band->block_rows; y++)
					for (uint32_t x = 0; x < band->block_columns; x++) {
						const size_t at = block0 + band->block_at + (size_t)y * band->block_stride + x;
						const uint32_t *slot = p->level_slot[f] + at;
						p->top[f][at] = 0;
						if (!*slot)
							continue;
						const struct surroundings s = {
							p->levels[*slot].level,
							p->levels[slot[-2 * next]].level,
							p->levels[slot[-next]].level,
							p->levels[slot[next]].level,
							p->levels[slot[2 * next]].level,
							{p->levels[p->level_slot[f == 0][at]].level, p->levels[p->level_slot[f == 2 ? 1 : 2][at]].level},
						};
						p->top[f][at] = block_settle(&p->levels[*slot], &s, limit, (double)rounding, &tally);
						*own = *own < p->top[f][at] ? p->top[f][at] : *own;
					}
			}
	while (tally.largest >> planes)
		planes++;
	for (int s = 0; s < 2; s++)
		centre[s] = tally.count[s] ? (float)(tally.excess[s] / (double)tally.count[s]) : 0;
	return planes;
}
