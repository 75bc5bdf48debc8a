/*
 * planes_row.h: what stands around the cells of one row of a block, eight lanes at once: of the contexts of FORMAT.md, "Bit
 * planes", everything but for what changes in the row itself.
 */
#ifndef CODEC_SPECTRAL_PLANES_ROW_H
#define CODEC_SPECTRAL_PLANES_ROW_H

#include <string.h>

#include "clones.h"
#include "planes.h"

/* 0: zero, 1: less than one and a half times the plane's value, 2: more. */
static ALWAYS_INLINE uint32_t tier(uint32_t near) { return (uint32_t)(near != 0) + (uint32_t)(near >= 6); }

/*
 * One row of a block in units of the plane's value. Comparisons are signed, as every processor has them; no value needs the sign.
 */
typedef uint16_t cells8 __attribute__((vector_size(2 * BLOCK_EDGE)));
typedef int16_t signed8 __attribute__((vector_size(2 * BLOCK_EDGE)));

static ALWAYS_INLINE cells8 cells_load(const uint16_t *from)
{
	cells8 v;
	memcpy(&v, from, sizeof v);
	return v;
}

/* 1 where v >= least, else 0: subtracted, as what is true is -1. */
#define CELLS_FROM(v, least) (-(cells8)((signed8)(v) > (int16_t)((least)-1)))

/*
 * The block at hand with a ring of its neighbours' cells, cell (y, x) at [y + 1][x + 1], and the blocks at the same place in
 * other harmonics and fields. Lanes behind the band's end are 0. All in units of this plane's value: what was last coded in the
 * plane above counts twice.
 */
enum { VIEW_STRIDE = 16 };
struct block_view {
	uint16_t near[BLOCK_EDGE + 2][VIEW_STRIDE];
	uint8_t sign[BLOCK_EDGE + 2][VIEW_STRIDE];
	const struct plane_block *before2, *before, *after, *after2, *other[2], *first;
	const uint16_t *parent;   /* of cell (0, 0) */
	uint32_t *known;          /* the block's own */
	const int32_t *level;     /* encoder only */
	uint32_t other_behind[2]; /* of other[]: 1 where that field's plane is still to be coded, else 0 */
	uint32_t parent_shift, orientation, band;
};

/* As it is before the row is coded. */
struct row_view {
	uint16_t around[BLOCK_EDGE], along[BLOCK_EDGE];
	uint16_t rest[BLOCK_EDGE];   /* 0 where along, the parent and the other fields are */
	uint16_t beyond[BLOCK_EDGE]; /* of the first context of a zero bit: the parent's and the other fields' share */
	uint16_t tiers[BLOCK_EDGE];  /* of the second: all but the left neighbour's */
};

/* 0: none of the row's cells, and nothing around them, is known to differ from 0; then *out is not set. */
static ALWAYS_INLINE int row_look(const struct block_view *v, uint32_t y, uint32_t width, uint32_t chroma, struct row_view *out)
{
	const uint16_t *k = &v->near[y + 1][1];
	const uint32_t at = y * BLOCK_EDGE;
	const cells8 left = cells_load(k - 1), here = cells_load(k), right = cells_load(k + 1);
	const cells8 up = cells_load(k - VIEW_STRIDE), down = cells_load(k + VIEW_STRIDE);
	const cells8 corners = (cells_load(k - VIEW_STRIDE - 1) + cells_load(k - VIEW_STRIDE + 1)) +
	                       (cells_load(k + VIEW_STRIDE - 1) + cells_load(k + VIEW_STRIDE + 1));
	const cells8 before2 = cells_load(v->before2->near + at), before = cells_load(v->before->near + at);
	const cells8 after = 2 * cells_load(v->after->near + at), after2 = 2 * cells_load(v->after2->near + at);
	const cells8 others = (cells_load(v->other[0]->near + at) << (uint16_t)v->other_behind[0]) +
	                      (cells_load(v->other[1]->near + at) << (uint16_t)v->other_behind[1]);
	const cells8 lane = {0, 1, 2, 3, 4, 5, 6, 7};
	cells8 parent = {0};

	if (v->parent_shift) {
		memcpy(&parent, v->parent + y / 2 * BLOCK_EDGE, sizeof parent / 2);
		parent = __builtin_shufflevector(parent, parent, 0, 0, 1, 1, 2, 2, 3, 3);
	} else {
		parent = cells_load(v->parent + y * BLOCK_EDGE);
	}
	parent &= (cells8)((signed8)lane < (int16_t)width); /* the parent's band may be wider */
	const cells8 around = 2 * ((left + right) + (up + down)) + corners, along = 2 * (before2 + after2) + (before + after);
	const cells8 rest = along | others | parent, any = here | around | rest;
	uint64_t word[2];
	memcpy(word, &any, sizeof word);
	if (!(word[0] | word[1]))
		return 0;
	const cells8 size_quarter = CELLS_FROM(parent, 4) + CELLS_FROM(parent, 26) + CELLS_FROM(parent, 162);
	const cells8 size_half =
		((CELLS_FROM(others, 2) + CELLS_FROM(others, 4)) + (CELLS_FROM(others, 11) + CELLS_FROM(others, 26))) +
		((CELLS_FROM(others, 64) + CELLS_FROM(others, 162)) + CELLS_FROM(others, 407));
	const cells8 beyond = (size_quarter * (SIZES / 2) + size_half) * (SIZES * SIZES * 2) + (uint16_t)chroma;
#define TIER(v) (CELLS_FROM(v, 1) + CELLS_FROM(v, 6))
	const cells8 ring = ((TIER(before2) * 3 + TIER(after2)) * 3 + TIER(before)) * 3 + TIER(after);
	const cells8 tiers = ring * 81 + ((TIER(up) * 3 + TIER(right)) * 3 + TIER(down));
#undef TIER
	memcpy(out->around, &around, sizeof around);
	memcpy(out->along, &along, sizeof along);
	memcpy(out->rest, &rest, sizeof rest);
	memcpy(out->beyond, &beyond, sizeof beyond);
	memcpy(out->tiers, &tiers, sizeof tiers);
	return 1;
}

#undef CELLS_FROM

#endif
