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

/* The blocks that hold what is around a block's cells, but for the block itself. */
struct surroundings {
	const int32_t *before2, *before, *after, *after2, *other[2];
};

/* A block's sizes with a ring of zeros. */
enum { RING_EDGE = BLOCK_EDGE + 2 };

static void sizes_fill(const struct level_block *block, int32_t size[RING_EDGE][RING_EDGE])
{
	for (int x = 0; x < RING_EDGE; x++)
		size[0][x] = size[RING_EDGE - 1][x] = 0;
	for (int y = 0; y < BLOCK_EDGE; y++) {
		size[y + 1][0] = size[y + 1][RING_EDGE - 1] = 0;
		for (int x = 0; x < BLOCK_EDGE; x++)
			size[y + 1][x + 1] = abs(block->level[y * BLOCK_EDGE + x]);
	}
}

static uint32_t around(const struct surroundings *s, const int32_t size[RING_EDGE][RING_EDGE], int k)
{
	const int y = k / BLOCK_EDGE, x = k % BLOCK_EDGE;
	const int32_t *up = size[y] + x, *here = size[y + 1] + x, *down = size[y + 2] + x;
	const int sum = 2 * (abs(s->before2[k]) + abs(s->after2[k])) + abs(s->before[k]) + abs(s->after[k]) + abs(s->other[0][k]) +
	                abs(s->other[1][k]) + (up[0] + up[1] + up[2]) + (here[0] + here[2]) + (down[0] + down[1] + down[2]);
	return sum < AROUND_MAX ? (uint32_t)sum : AROUND_MAX;
}

/* Bit k is 1 where level k is not 0. */
static uint64_t levels_there(const struct level_block *block)
{
	uint64_t there = 0;
	for (int y = 0; y < BLOCK_EDGE; y++) {
		static const int32_t BIT[BLOCK_EDGE] = {1, 2, 4, 8, 16, 32, 64, 128};
		int32_t row = 0;
		for (int x = 0; x < BLOCK_EDGE; x++)
			row |= block->level[y * BLOCK_EDGE + x] ? BIT[x] : 0;
		there |= (uint64_t)row << y * BLOCK_EDGE;
	}
	return there;
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
	int32_t size_of[RING_EDGE][RING_EDGE];
	uint32_t sizes = 0;
	sizes_fill(block, size_of);
	for (uint64_t left = levels_there(block); left; left &= left - 1) {
		const int k = __builtin_ctzll(left);
		const uint32_t size = (uint32_t)abs(block->level[k]);
		if (size == 1 && block->over[k] < limit[0] &&
		    block->over[k] < limit[around(s, (const int32_t(*)[RING_EDGE])size_of, k)]) {
			block->level[k] = size_of[k / BLOCK_EDGE + 1][k % BLOCK_EDGE + 1] = 0;
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
