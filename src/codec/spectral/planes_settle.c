/*
 * planes_settle.c: which levels are coded, and what the coder must know of them as a whole.
 *
 * The levels of a harmonic are chosen together, by what they are likely to cost where they are: by the sum of the sizes around
 * them, those of harmonics and fields that are chosen already as they are, the others as planes_quantise left them.
 */
#include <stdlib.h>
#include <string.h>

#include "clones.h"
#include "planes_row.h"

/* The blocks that hold what is around a block's cells, but for the block itself. */
struct surroundings {
	const uint8_t *before2, *before, *after, *after2, *other[2];
};

static ALWAYS_INLINE cells8 cells_widen(const uint8_t *from)
{
	typedef uint8_t bytes8 __attribute__((vector_size(BLOCK_EDGE)));
	bytes8 v;
	memcpy(&v, from, sizeof v);
	return __builtin_convertvector(v, cells8);
}

/*
 * For each cell of a block: neighbours in the block and the nearest harmonics and other fields once, the harmonics of its own
 * parity twice.
 */
static ALWAYS_INLINE void sums_around(const struct level_block *block, const struct surroundings *s, uint16_t sum[BLOCK_CELLS])
{
	uint16_t ring[BLOCK_EDGE + 2][VIEW_STRIDE] = {{0}};
	for (uint32_t y = 0; y < BLOCK_EDGE; y++) {
		const cells8 row = cells_widen(block->near + y * BLOCK_EDGE);
		memcpy(&ring[y + 1][1], &row, sizeof row);
	}
	for (uint32_t y = 0, at = 0; y < BLOCK_EDGE; y++, at += BLOCK_EDGE) {
		const uint16_t *here = &ring[y + 1][1], *up = here - VIEW_STRIDE, *down = here + VIEW_STRIDE;
		const cells8 beside = (cells_load(here - 1) + cells_load(here + 1)) + (cells_load(up) + cells_load(down));
		const cells8 corners = (cells_load(up - 1) + cells_load(up + 1)) + (cells_load(down - 1) + cells_load(down + 1));
		const cells8 alike = 2 * (cells_widen(s->before2 + at) + cells_widen(s->after2 + at));
		const cells8 others = (cells_widen(s->before + at) + cells_widen(s->after + at)) +
		                      (cells_widen(s->other[0] + at) + cells_widen(s->other[1] + at));
		const cells8 all = (beside + corners) + (alike + others);
		memcpy(sum + at, &all, sizeof all);
	}
}

/* What is told of all levels. */
struct tally {
	double beyond[3];
	uint64_t count[3];
	uint32_t sizes; /* or-ed */
};

/* The block's candidates as cells of the trellis; returns how many. */
static ALWAYS_INLINE uint32_t block_list(const struct level_block *block, uint32_t slot, const struct surroundings *s,
                                         const uint8_t class_of[TRELLIS_SUMS], struct trellis_cell *cells)
{
	uint16_t sum[BLOCK_CELLS];
	uint32_t n = 0;
	sums_around(block, s, sum);
	for (uint64_t left = block->there; left; left &= left - 1) {
		const uint32_t k = (uint32_t)__builtin_ctzll(left);
		cells[n++] = (struct trellis_cell){.level = (uint32_t)abs(block->level[k]),
		                                   .beyond = ((float)block->over[k] + 0.5f) / 256 - LEVEL_ROUNDING,
		                                   .place = slot * BLOCK_CELLS + k,
		                                   .around = class_of[sum[k] < TRELLIS_SUMS ? sum[k] : TRELLIS_SUMS - 1]};
	}
	return n;
}

/* What was chosen, back in its block. */
static void cell_settle(struct planes *p, const struct trellis_cell *cell, struct tally *tally)
{
	struct level_block *block = &p->levels[cell->place / BLOCK_CELLS];
	const uint32_t k = cell->place % BLOCK_CELLS;
	block->level[k] = block->negative >> k & 1 ? -(int32_t)cell->level : (int32_t)cell->level;
	block->near[k] = (uint8_t)(cell->level < LEVEL_NEAR_MOST ? cell->level : LEVEL_NEAR_MOST);
	if (cell->level) {
		const uint32_t kind = cell->level > 1 ? 2 : cell->quantiser;
		tally->beyond[kind] += (double)cell->beyond;
		tally->count[kind]++;
		tally->sizes |= cell->level;
	}
}

/* The planes that a block needs. */
static ALWAYS_INLINE uint8_t block_top(const struct level_block *block)
{
	uint32_t sizes = 0;
	for (uint32_t k = 0; k < BLOCK_CELLS; k++)
		sizes |= (uint32_t)abs(block->level[k]);
	return sizes ? (uint8_t)(32 - __builtin_clz(sizes)) : 0;
}

/* The candidates of a harmonic, block by block in the order of coding; block0: of the harmonic's blocks. */
AVX2_CLONE static uint32_t harmonic_list(struct planes *p, uint32_t f, size_t block0, const uint8_t class_of[TRELLIS_SUMS])
{
	const ptrdiff_t next = (ptrdiff_t)p->bands.blocks;
	uint32_t count = 0;
	for (size_t at = block0; at < block0 + p->bands.blocks; at++) { /* padding holds nothing */
		const uint32_t *slot = p->level_slot[f] + at;
		if (!*slot)
			continue;
		const struct surroundings s = {
			p->levels[slot[-2 * next]].near,
			p->levels[slot[-next]].near,
			p->levels[slot[next]].near,
			p->levels[slot[2 * next]].near,
			{p->levels[p->level_slot[f == 0][at]].near, p->levels[p->level_slot[f == 2 ? 1 : 2][at]].near},
		};
		count += block_list(&p->levels[*slot], *slot, &s, class_of, p->cells + count);
	}
	return count;
}

AVX2_CLONE static void harmonic_tops(struct planes *p, uint32_t f, size_t block0)
{
	for (uint32_t b = 0; b < p->bands.count; b++) {
		const struct band *band = &p->bands.band[b];
		const size_t first = block0 + band->block_at - band->block_stride - 1;
		uint8_t *top = p->top[f] + first; /* padding: of the band */
		top[0] = 0;
		for (uint32_t n = 1; n < (band->block_rows + 2) * band->block_stride; n++) {
			const uint32_t slot = p->level_slot[f][first + n];
			top[n] = slot ? block_top(&p->levels[slot]) : 0;
			top[0] = top[0] < top[n] ? top[n] : top[0];
		}
	}
}

uint32_t planes_settle(struct planes *p, float centre[3])
{
	struct tally tally = {0};
	uint8_t class_of[TRELLIS_SUMS];

	trellis_classes(class_of);
	for (uint32_t f = 0; f < 3; f++)
		for (uint32_t m = 0; m < p->dims.phi_d; m++) {
			const size_t block0 = (size_t)(m + 2) * p->bands.blocks;
			const uint32_t count = harmonic_list(p, f, block0, class_of);
			trellis_choose(p->cells, count, p->costs);
			for (uint32_t i = 0; i < count; i++)
				cell_settle(p, &p->cells[i], &tally);
			harmonic_tops(p, f, block0);
		}
	for (int kind = 0; kind < 3; kind++)
		centre[kind] = tally.count[kind] ? (float)(tally.beyond[kind] / (double)tally.count[kind]) : 0;
	return tally.sizes ? (uint32_t)(32 - __builtin_clz(tally.sizes)) : 0;
}
