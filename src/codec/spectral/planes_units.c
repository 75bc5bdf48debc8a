/*
 * planes_units.c: coding and decoding of one unit of bit planes (FORMAT.md, "Bit planes").
 *
 * One text serves both directions: every function takes `decode`, a constant after inlining. (Compiled for AVX2 besides it gained
 * 6 %: the time goes into bits that depend on each other.)
 */
#include <stdlib.h>
#include <string.h>

#include "planes_row.h"

static ALWAYS_INLINE uint32_t size_of(const struct plane_contexts *c, uint32_t v)
{
	return c->size[v < SIZE_TABLE ? v : SIZE_TABLE - 1];
}

static ALWAYS_INLINE uint32_t harmonic_class(uint32_t m)
{
	return m < 2 ? m : m < 4 ? 2 : m < 8 ? 3 : m < 16 ? 4 : m < 32 ? 5 : m < 64 ? 6 : 7;
}

/* Where one unit works. */
struct place {
	struct planes *planes;
	struct plane_contexts *contexts;
	struct mixed_coder *coder;
	uint32_t plane, field, harmonic, chroma;
	uint32_t depth, harmonic_class;
	size_t blocks;  /* of a plane, padding included: from harmonic to harmonic */
	uint32_t *slot; /* of this field and harmonic */
	uint8_t *active;
	const uint32_t *other_slot[2]; /* the other fields' */
	const uint32_t *first_slot;
	const uint8_t *first_active, *second_active; /* of fields 0 and 1, for fields after them */
	uint32_t *bands; /* bands_active of this field and harmonic, and those of the two fields likewise */
	uint32_t first_bands, second_bands;
};

static ALWAYS_INLINE uint32_t code_band_flag(const struct place *u, int decode, uint32_t b, uint32_t bit)
{
	struct plane_contexts *c = u->contexts;
	const uint32_t *bands = u->bands;
	const int32_t above = u->planes->bands.band[b].parent;
	const uint32_t parent = above < 0 ? 0 : bands[0] >> above & 1;

	if (!(((bands[-2] | bands[-1] | bands[1] | bands[2] | u->first_bands | u->second_bands) >> b & 1) | parent))
		return mixed_bit_alone(u->coder, decode, &c->quiet.band[u->harmonic_class * 2 + u->chroma], bit);
	const uint32_t near = (bands[-1] >> b & 1) + (bands[1] >> b & 1), alike = (bands[-2] >> b & 1) + (bands[2] >> b & 1);
	const uint32_t others = (u->first_bands >> b & 1) + (u->second_bands >> b & 1);
	return mixed_bit_pair(u->coder, decode,
	                      &c->mixed.band[0][(((near * 3 + alike) * 2 + (parent | (above < 0))) * 3 + others) * 2 + u->chroma],
	                      &c->mixed.band[1][(near + alike) * BANDS_MAX + b], bit);
}

/*
 * The flags of a harmonic with no active band, in it or near it, up to the first that is 1: its band, or their count. Most units
 * hold nothing else.
 */
static ALWAYS_INLINE uint32_t code_quiet_bands(const struct place *u, int decode, const uint8_t *top)
{
	const struct bands *bands = &u->planes->bands;
	mixer_context *context = &u->contexts->quiet.band[u->harmonic_class * 2 + u->chroma], state = *context;
	uint32_t b = 0, bit = 0;

	for (; b < bands->count; b++) {
		bit = !decode && top[bands->band[b].block_at - bands->band[b].block_stride - 1] > u->plane;
		bit = mixed_bit_with(u->coder, decode, state >> 16, bit);
		state = mixer_context_learnt(u->coder->tables, state, bit, MIXER_SEEN_MAX_ALONE);
		if (bit)
			break;
	}
	*context = state;
	return b;
}

/* `above`: the active blocks of the row of parents; NULL in band 0. */
static ALWAYS_INLINE uint32_t code_block_flag(const struct place *u, int decode, uint32_t b, uint32_t x, size_t at,
                                              const uint8_t *above, uint32_t bit)
{
	struct plane_contexts *c = u->contexts;
	const struct band *band = &u->planes->bands.band[b];
	const uint8_t *flag = u->active + at;
	const ptrdiff_t row = band->block_stride, next = (ptrdiff_t)u->blocks;
	const uint32_t beside = ((uint32_t)flag[-1] + flag[1]) + ((uint32_t)flag[-row] + flag[row]);
	const uint32_t corners = (uint32_t)flag[-row - 1] + flag[-row + 1];
	const uint32_t near = (uint32_t)flag[-next] + flag[next], alike = (uint32_t)flag[-2 * next] + flag[2 * next];
	const uint32_t others = (u->field > 0 ? u->first_active[at] : 0u) + (u->field > 1 ? u->second_active[at] : 0u);
	uint32_t parent = 0;

	if (above) {
		const uint32_t px = x >> band->parent_shift, last = u->planes->bands.band[band->parent].block_columns - 1;
		parent = above[px < last ? px : last];
	}
	if (!(beside | corners | near | alike | others | parent))
		return mixed_bit_alone(u->coder, decode, &c->quiet.block[(u->harmonic_class * BANDS_MAX + b) * 2 + u->chroma], bit);
	return mixed_bit_pair(u->coder, decode, &c->mixed.block[0][(((beside * 3 + corners) * 3 + alike) * 3 + near) * 2 + parent],
	                      &c->mixed.block[1][(((b * 3 + alike) * 3 + near) * 3 + others) * 2 + u->chroma], bit);
}

/* The active blocks among the parents of a band's row y of blocks. */
static ALWAYS_INLINE const uint8_t *parents_active(const struct place *u, const struct band *band, uint32_t y)
{
	if (band->parent < 0)
		return NULL;
	const struct band *above = &u->planes->bands.band[band->parent];
	const uint32_t py = y >> band->parent_shift, last = above->block_rows - 1;
	return u->active + above->block_at + (size_t)(py < last ? py : last) * above->block_stride;
}

static ALWAYS_INLINE void block_gather(const struct place *u, int decode, uint32_t b, uint32_t by, uint32_t bx, size_t at,
                                       struct block_view *v)
{
	const struct planes *p = u->planes;
	const struct band *band = &p->bands.band[b];
	struct plane_block *pool = p->pool;
	const uint32_t *slot = u->slot + at;
	const ptrdiff_t row = band->block_stride, next = (ptrdiff_t)u->blocks;
	struct plane_block *own = pool + slot[0];
	const struct plane_block *left = pool + slot[-1], *right = pool + slot[1], *up = pool + slot[-row], *down = pool + slot[row];
	enum { LAST = BLOCK_EDGE - 1, LAST_ROW = BLOCK_EDGE * LAST };

	v->near[0][0] = pool[slot[-row - 1]].near[BLOCK_CELLS - 1];
	v->near[0][BLOCK_EDGE + 1] = pool[slot[-row + 1]].near[LAST_ROW];
	v->near[BLOCK_EDGE + 1][0] = (uint16_t)(2 * pool[slot[row - 1]].near[LAST]);
	v->near[BLOCK_EDGE + 1][BLOCK_EDGE + 1] = (uint16_t)(2 * pool[slot[row + 1]].near[0]);
	memcpy(&v->near[0][1], up->near + LAST_ROW, sizeof(cells8));
	memcpy(&v->sign[0][1], up->sign + LAST_ROW, BLOCK_EDGE);
	const cells8 below = 2 * cells_load(down->near);
	memcpy(&v->near[BLOCK_EDGE + 1][1], &below, sizeof below);
	memcpy(&v->sign[BLOCK_EDGE + 1][1], down->sign, BLOCK_EDGE);
	for (uint32_t y = 0; y < BLOCK_EDGE; y++) {
		const cells8 here = 2 * cells_load(own->near + y * BLOCK_EDGE);
		memcpy(&v->near[y + 1][1], &here, sizeof here);
		memcpy(&v->sign[y + 1][1], own->sign + y * BLOCK_EDGE, BLOCK_EDGE);
		v->near[y + 1][0] = left->near[y * BLOCK_EDGE + LAST];
		v->sign[y + 1][0] = left->sign[y * BLOCK_EDGE + LAST];
		v->near[y + 1][BLOCK_EDGE + 1] = (uint16_t)(2 * right->near[y * BLOCK_EDGE]);
		v->sign[y + 1][BLOCK_EDGE + 1] = right->sign[y * BLOCK_EDGE];
	}
	v->before2 = pool + slot[-2 * next];
	v->before = pool + slot[-next];
	v->after = pool + slot[next];
	v->after2 = pool + slot[2 * next];
	v->other[0] = pool + u->other_slot[0][at];
	v->other[1] = pool + u->other_slot[1][at];
	v->first = pool + u->first_slot[at];
	v->other_behind[0] = u->field == 0;
	v->other_behind[1] = u->field < 2;
	v->known = own->known;
	v->parent = pool->near;
	v->parent_shift = band->parent_shift;
	v->orientation = band->orientation;
	v->band = b;
	if (band->parent >= 0) {
		/* The parents of a block's cells lie in one block: in all of it, or in a quarter. */
		const struct band *above = &p->bands.band[band->parent];
		const uint32_t s = band->parent_shift, edge = s ? BLOCK_EDGE / 2 : 0;
		v->parent = pool[u->slot[above->block_at + (by >> s) * above->block_stride + (bx >> s)]].near +
		            (by & 1) * edge * BLOCK_EDGE + (bx & 1) * edge;
	}
	v->level = decode ? NULL : p->levels[p->level_slot[u->field][(size_t)(u->harmonic + 2) * p->bands.blocks + at]].level;
}

static ALWAYS_INLINE void block_scatter(const struct block_view *v, struct plane_block *own)
{
	for (uint32_t y = 0; y < BLOCK_EDGE; y++) {
		memcpy(own->near + y * BLOCK_EDGE, &v->near[y + 1][1], BLOCK_EDGE * sizeof(uint16_t));
		memcpy(own->sign + y * BLOCK_EDGE, &v->sign[y + 1][1], BLOCK_EDGE);
	}
}

static ALWAYS_INLINE uint32_t code_sign(const struct place *u, int decode, const struct block_view *v, uint32_t y, uint32_t x,
                                        uint32_t bit)
{
	struct plane_contexts *c = u->contexts;
	const uint8_t *s = &v->sign[y + 1][x + 1];
	const uint32_t k = y * BLOCK_EDGE + x, first = u->field ? v->first->sign[k] : 0;
	mixer_context *const context[MIXER_INPUTS] = {
		&c->mixed.sign[0][(s[-1] * 3u + s[-VIEW_STRIDE]) * BANDS_MAX + v->band],
		&c->mixed.sign[1][((v->before2->sign[k] * 3u + v->after2->sign[k]) * 3 + v->before->sign[k]) * 3 + first],
		&c->mixed.sign[2][(((s[-1] * 3u + s[1]) * 3 + s[-VIEW_STRIDE]) * 3 + s[VIEW_STRIDE]) * 4 + v->orientation],
		&c->mixed.sign[3][(first * 2 + (u->field > 1)) * BANDS_MAX + v->band],
	};
	return mixed_bit(u->coder, decode, context, &c->sign_weights[u->chroma], bit);
}

static ALWAYS_INLINE uint32_t quiet_index(const struct place *u, uint32_t b, uint32_t fresh)
{
	return (((u->harmonic_class * BANDS_MAX + b) * 3 + u->depth) * 2 + u->chroma) * 2 + fresh;
}

/* This plane's bit of cell (y, x) and those above; encoder only. */
static ALWAYS_INLINE uint32_t level_above(const struct place *u, const struct block_view *v, uint32_t y, uint32_t x)
{
	return (uint32_t)abs(v->level[y * BLOCK_EDGE + x]) >> u->plane;
}

/* The cell's level is not 0 from this plane on. */
static ALWAYS_INLINE void cell_begin(const struct place *u, int decode, struct block_view *v, uint32_t y, uint32_t x)
{
	const uint32_t half = u->plane ? 2 : 0;
	v->sign[y + 1][x + 1] = (uint8_t)(1 + code_sign(u, decode, v, y, x, !decode && v->level[y * BLOCK_EDGE + x] < 0));
	v->known[y * BLOCK_EDGE + x] = (4 + half) << u->plane;
	v->near[y + 1][x + 1] = (uint16_t)(4 + half);
}

/* One level's bit of this plane; `around` as it is now. */
static ALWAYS_INLINE void code_cell(const struct place *u, int decode, struct block_view *v, const struct row_view *row,
                                    uint32_t y, uint32_t x, uint32_t around, uint32_t fresh)
{
	struct plane_contexts *c = u->contexts;
	const uint32_t plane = u->plane, b = v->band, along = row->along[x];
	uint16_t *near = &v->near[y + 1][x + 1];
	const uint32_t target = decode ? 0 : level_above(u, v, y, x);

	if (*near) {
		const uint32_t half = plane ? 2 : 0, most = (uint32_t)*near >> 3, tall = most < 4 ? most : most < 8 ? 4 : 5;
		const uint32_t bit =
			mixed_bit_pair(u->coder, decode, &c->mixed.refine[0][(tall * SIZES + size_of(c, along)) * 2 + u->chroma],
		                   &c->mixed.refine[1][(tall * BANDS_MAX + b) * SIZES + size_of(c, (around + along) >> 1)], target & 1);
		uint32_t *known = &v->known[y * BLOCK_EDGE + x];
		const uint32_t now = (*known >> (plane + 3) << 1 | bit) * 4 + half; /* the planes above this one, and this one's bit */
		*known = now << plane;
		*near = (uint16_t)(now < NEAR_MOST ? now : NEAR_MOST);
		return;
	}
	uint32_t bit;
	if (!(around | row->rest[x]))
		bit = mixed_bit_alone(u->coder, decode, &c->quiet.cell[quiet_index(u, b, fresh)], target);
	else
		bit = mixed_bit_pair(u->coder, decode,
		                     &c->mixed.zero[0][row->beyond[x] + (size_of(c, around) * SIZES + size_of(c, along)) * 2],
		                     &c->mixed.zero[1][row->tiers[x] + tier(near[-1]) * 27], target);
	if (bit)
		cell_begin(u, decode, v, y, x);
}

/*
 * A row with nothing around it: one bit tells whether all of it stays 0, else where the first one is that does not. Returns
 * that one's place, or the width.
 */
static ALWAYS_INLINE uint32_t code_quiet_row(const struct place *u, int decode, const struct block_view *v, uint32_t y,
                                             uint32_t width, uint32_t fresh)
{
	struct plane_contexts *c = u->contexts;
	uint32_t place = 0;

	while (!decode && place < width && !level_above(u, v, y, place))
		place++;
	if (!mixed_bit_alone(u->coder, decode, &c->quiet.row[quiet_index(u, v->band, fresh)], place < width))
		return width;
	for (uint32_t i = 0; i + 1 < width; i++)
		if (mixed_bit_alone(u->coder, decode, &c->mixed.first[width - 1 - i], i == place))
			return i;
	return width - 1;
}

static ALWAYS_INLINE void code_row(const struct place *u, int decode, struct block_view *v, uint32_t y, uint32_t width,
                                   uint32_t fresh)
{
	struct row_view row;
	uint32_t start = 0, change = 0; /* twice what has been added to the left neighbour since the look */

	if (!row_look(v, y, width, u->chroma, &row)) {
		start = code_quiet_row(u, decode, v, y, width, fresh);
		if (start == width)
			return;
		cell_begin(u, decode, v, y, start);
		change = 2u * v->near[y + 1][1 + start++];
		memset(&row, 0, sizeof row);
		for (uint32_t i = 0; i < BLOCK_EDGE; i++)
			row.beyond[i] = (uint16_t)u->chroma;
	}
	for (uint32_t x = start; x < width; x++) {
		const uint32_t before = v->near[y + 1][x + 1];
		code_cell(u, decode, v, &row, y, x, row.around[x] + change, fresh);
		change = 2 * (v->near[y + 1][x + 1] - before);
	}
}

static ALWAYS_INLINE void code_block(const struct place *u, int decode, uint32_t b, uint32_t by, uint32_t bx, size_t at,
                                     uint32_t fresh)
{
	const struct band *band = &u->planes->bands.band[b];
	const uint32_t x = bx * BLOCK_EDGE, y = by * BLOCK_EDGE;
	const uint32_t width = x + BLOCK_EDGE < band->columns ? BLOCK_EDGE : band->columns - x;
	const uint32_t height = y + BLOCK_EDGE < band->rows ? BLOCK_EDGE : band->rows - y;
	struct block_view view;

	block_gather(u, decode, b, by, bx, at, &view);
	for (uint32_t i = 0; i < height; i++)
		code_row(u, decode, &view, i, width, fresh);
	block_scatter(&view, &u->planes->pool[u->slot[at]]);
}

static ALWAYS_INLINE void unit_code(struct planes *p, struct mixed_coder *coder, uint32_t unit, int decode)
{
	const uint32_t harmonics = p->dims.phi_d, field = unit / harmonics % 3, harmonic = unit % harmonics;
	const uint32_t plane = p->planes - 1 - unit / (3 * harmonics);
	const size_t block0 = (size_t)(harmonic + 2) * p->bands.blocks;
	const struct place u = {
		.planes = p,
		.contexts = &p->contexts,
		.coder = coder,
		.plane = plane,
		.field = field,
		.harmonic = harmonic,
		.chroma = field > 0,
		.depth = plane == 0  ? 0
	             : plane < 3 ? 1
	                         : 2,
		.harmonic_class = harmonic_class(harmonic),
		.blocks = p->bands.blocks,
		.slot = p->slot[field] + block0,
		.active = p->active[field] + block0,
		.other_slot = {p->slot[field == 0] + block0, p->slot[field == 2 ? 1 : 2] + block0},
		.first_slot = p->slot[0] + block0,
		.first_active = p->active[0] + block0,
		.second_active = p->active[1] + block0,
		.bands = p->bands_active[field] + harmonic + 2,
		.first_bands = field > 0 ? p->bands_active[0][harmonic + 2] : 0,
		.second_bands = field > 1 ? p->bands_active[1][harmonic + 2] : 0,
	};
	const uint8_t *top = decode ? NULL : p->top[field] + block0;

	uint32_t first = 0;
	if (!(u.bands[-2] | u.bands[-1] | u.bands[0] | u.bands[1] | u.bands[2] | u.first_bands | u.second_bands)) {
		first = code_quiet_bands(&u, decode, top);
		if (first < p->bands.count)
			*u.bands = 1u << first;
	}
	for (uint32_t b = first; b < p->bands.count; b++) {
		const struct band *band = &p->bands.band[b];
		if (!(*u.bands >> b & 1)) {
			if (!code_band_flag(&u, decode, b, !decode && top[band->block_at - band->block_stride - 1] > plane))
				continue;
			*u.bands |= 1u << b;
		}
		for (uint32_t by = 0; by < band->block_rows; by++) {
			const uint8_t *above = parents_active(&u, band, by);
			const size_t row = band->block_at + (size_t)by * band->block_stride;
			for (uint32_t bx = 0; bx < band->block_columns; bx++) {
				const size_t at = row + bx;
				const uint32_t fresh = !u.active[at];
				if (fresh) {
					if (!code_block_flag(&u, decode, b, bx, at, above, !decode && top[at] > plane))
						continue;
					u.active[at] = 1;
					u.slot[at] = p->pool_count++;
					memset(&p->pool[u.slot[at]], 0, sizeof *p->pool);
				}
				code_block(&u, decode, b, by, bx, at, fresh);
			}
		}
	}
}

void planes_encode_unit(struct planes *planes, struct mixed_coder *coder, uint32_t unit)
{
	/* A copy that nothing else points to can stay in registers. */
	struct range_encoder encoder = *coder->encoder;
	struct mixed_coder own = {.encoder = &encoder, .tables = coder->tables};
	unit_code(planes, &own, unit, 0);
	*coder->encoder = encoder;
}

bp_status planes_decode_unit(struct planes *planes, struct mixed_coder *coder, uint32_t unit, bp_error *error)
{
	const bp_status status = planes_pool_grow(planes, error);
	if (status)
		return status;
	struct mixed_coder own = *coder; /* likewise */
	unit_code(planes, &own, unit, 1);
	*coder = own;
	return BP_OK;
}
