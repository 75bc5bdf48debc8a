#include "default_planes.h"

#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "../memory.h"

enum { INPUTS = MIXER_INPUTS, HARMONIC_CLASSES = 8, SIZES = 16 };

/* Contexts of each kind of bit, one array for each input of the mixer; FORMAT.md has the meaning of the indices. */
struct plane_contexts {
	mixer_context band[INPUTS][120];
	mixer_context block[INPUTS][BANDS_MAX * 54];
	mixer_context zero[INPUTS][144 * SIZES];
	mixer_context quiet[HARMONIC_CLASSES * BANDS_MAX * 12], quiet_band[HARMONIC_CLASSES * 2], quiet_block[HARMONIC_CLASSES * BANDS_MAX * 2];
	mixer_context sign[INPUTS][81 * 4];
	mixer_context refine[INPUTS][6 * BANDS_MAX * SIZES];
	struct mixer_weights band_weights[2], block_weights[2 * BANDS_MAX], zero_weights[2 * BANDS_MAX * 3], sign_weights[2], refine_weights[6];
};

/* Where nothing around is known to differ from 0, a cell, block or band starts at a probability of 1/50 as if it had seen six bits. */
enum { QUIET_START = 83886 << 10 | 6 };

static void contexts_reset(struct plane_contexts *c)
{
	mixer_context *context = (mixer_context *)c;
	const size_t count = offsetof(struct plane_contexts, band_weights) / sizeof *context;
	int32_t *weight = (int32_t *)c->band_weights;

	for (size_t i = 0; i < count; i++)
		context[i] = MIXER_CONTEXT_EVEN;
	for (size_t i = offsetof(struct plane_contexts, quiet) / sizeof *context; i < offsetof(struct plane_contexts, sign) / sizeof *context; i++)
		context[i] = QUIET_START;
	for (size_t i = 0; i < (sizeof *c - offsetof(struct plane_contexts, band_weights)) / sizeof *weight; i++)
		weight[i] = MIXER_WEIGHT_START;
}

bp_status planes_create(struct lattice_dims dims, int encoder, struct planes **out, bp_error *error)
{
	struct planes *p = calloc(1, sizeof *p);

	if (!p)
		return error_memory(error, sizeof *p);
	p->dims = dims;
	bands_lay_out(dims.theta_h, dims.theta_d, &p->bands);
	const size_t harmonics = dims.phi_d + 4, cells = harmonics * p->bands.cells, blocks = harmonics * p->bands.blocks;
	const size_t bytes = 3 * (cells * (encoder ? 9 : 5) + blocks * (encoder ? 2 : 1));
	unsigned char *at = p->block = calloc(bytes, 1);
	p->contexts = malloc(sizeof *p->contexts);
	if (!at || !p->contexts) {
		planes_free(p);
		return error_memory(error, bytes);
	}
	memory_prefer_huge(at, bytes);
	/* The wider ones first, so that all are aligned. */
	for (int f = 0; f < 3; f++, at += cells * sizeof(uint32_t))
		p->known[f] = (uint32_t *)(void *)at;
	for (int f = 0; f < 3 && encoder; f++, at += cells * sizeof(int32_t))
		p->level[f] = (int32_t *)(void *)at;
	for (int f = 0; f < 3; f++, at += cells)
		p->sign[f] = at;
	for (int f = 0; f < 3; f++, at += blocks)
		p->active[f] = at;
	for (int f = 0; f < 3 && encoder; f++, at += blocks)
		p->top[f] = at;
	contexts_reset(p->contexts);
	*out = p;
	return BP_OK;
}

void planes_free(struct planes *p)
{
	if (!p)
		return;
	free(p->block);
	free(p->contexts);
	free(p);
}

void planes_start(struct planes *p, uint32_t count)
{
	const size_t harmonics = p->dims.phi_d + 4;
	for (int f = 0; f < 3 && p->planes; f++) {
		memset(p->known[f], 0, harmonics * p->bands.cells * sizeof *p->known[f]);
		memset(p->sign[f], 0, harmonics * p->bands.cells);
		memset(p->active[f], 0, harmonics * p->bands.blocks);
	}
	p->planes = count;
	contexts_reset(p->contexts);
}

/* ---- contexts ---- */

/* A size of v in 16 classes, about one and a half to the octave. */
static inline uint32_t size_of(uint32_t v)
{
	static const uint8_t small[32] = {0, 1, 2, 3, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6, 6, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 8, 8, 8, 8, 8, 8};
	static const uint16_t least[16] = {0, 1, 2, 3, 4, 7, 11, 16, 26, 41, 64, 102, 162, 256, 407, 646};
	if (v < 32)
		return small[v];
	uint32_t q = 8;
	while (q < 15 && v >= least[q + 1])
		q++;
	return q;
}

static inline uint32_t harmonic_class(uint32_t m)
{
	return m < 2 ? m : m < 4 ? 2 : m < 8 ? 3 : m < 16 ? 4 : m < 32 ? 5 : m < 64 ? 6 : 7;
}

/* 0: zero, 1: less than one and a half times the plane's value, 2: more. */
static inline uint32_t tier(uint32_t known, uint32_t plane)
{
	return known == 0 ? 0 : known >> plane < 6 ? 1 : 2;
}

/* Where one unit works. */
struct place {
	struct planes *planes;
	struct mixed_coder *coder;
	uint32_t plane, field, harmonic, chroma;
	size_t cells, blocks; /* of a padded plane */
	uint32_t *known;      /* of this field and harmonic, as the next three */
	uint8_t *sign, *active;
	const int32_t *level;
	const uint32_t *other[2]; /* the other fields' known levels; both the same where there is but one */
	const uint8_t *first_sign, *first_active, *second_active; /* of fields 0 and 1, for fields after them */
};

static inline uint32_t other_active(const struct place *u, size_t at)
{
	return (u->field > 0 ? u->first_active[at] : 0u) + (u->field > 1 ? u->second_active[at] : 0u);
}

static inline __attribute__((always_inline)) uint32_t code_band_flag(const struct place *u, int decode, uint32_t b, size_t at, uint32_t bit)
{
	struct plane_contexts *c = u->planes->contexts;
	const struct band *band = &u->planes->bands.band[b];
	const uint8_t *flag = u->active + at;
	const size_t next = u->blocks;
	const uint32_t near = (uint32_t)flag[-(ptrdiff_t)next] + flag[next];
	const uint32_t alike = (uint32_t)flag[-2 * (ptrdiff_t)next] + flag[2 * next];
	const uint32_t others = other_active(u, at);
	uint32_t parent = 1;

	if (band->parent >= 0) {
		const struct band *above = &u->planes->bands.band[band->parent];
		parent = u->active[above->block_at - above->block_stride - 1];
	}
	if (!(near | alike | others) && (!parent || band->parent < 0))
		return mixed_bit_alone(u->coder, decode, &c->quiet_band[harmonic_class(u->harmonic) * 2 + u->chroma], bit);
	mixer_context *const context[INPUTS] = {
		&c->band[0][(((near * 3 + alike) * 2 + parent) * 3 + others) * 2 + u->chroma],
		&c->band[1][(b * 2 + parent) * 2 + u->chroma],
		&c->band[2][(near + alike) * BANDS_MAX + b],
		&c->band[3][((others * 2 + (alike > 0)) * 2 + (near > 0)) * 2 + u->harmonic % 2],
	};
	return mixed_bit(u->coder, decode, context, &c->band_weights[u->chroma], bit);
}

static inline __attribute__((always_inline)) uint32_t code_block_flag(const struct place *u, int decode, uint32_t b, uint32_t y, uint32_t x,
                                                                      size_t at, uint32_t bit)
{
	struct plane_contexts *c = u->planes->contexts;
	const struct band *band = &u->planes->bands.band[b];
	const uint8_t *flag = u->active + at;
	const size_t next = u->blocks;
	/* The padding holds the band's own flag in one corner, so the border is tested after all. */
	const uint32_t left = x ? flag[-1] : 0, up = y ? flag[-(ptrdiff_t)band->block_stride] : 0;
	const uint32_t right = x + 1 < band->block_columns ? flag[1] : 0, down = y + 1 < band->block_rows ? flag[band->block_stride] : 0;
	const uint32_t beside = left + up + right + down;
	const uint32_t corners = (x && y ? flag[-(ptrdiff_t)band->block_stride - 1] : 0u) +
	                         (y && x + 1 < band->block_columns ? flag[-(ptrdiff_t)band->block_stride + 1] : 0u);
	const uint32_t near = (uint32_t)flag[-(ptrdiff_t)next] + flag[next];
	const uint32_t alike = (uint32_t)flag[-2 * (ptrdiff_t)next] + flag[2 * next];
	const uint32_t others = other_active(u, at);
	uint32_t parent = 0;

	if (band->parent >= 0) {
		const struct band *above = &u->planes->bands.band[band->parent];
		uint32_t py = y >> band->parent_shift, px = x >> band->parent_shift;
		py = py < above->block_rows ? py : above->block_rows - 1;
		px = px < above->block_columns ? px : above->block_columns - 1;
		parent = u->active[above->block_at + py * above->block_stride + px];
	}
	if (!(beside | corners | near | alike | others | parent))
		return mixed_bit_alone(u->coder, decode, &c->quiet_block[(harmonic_class(u->harmonic) * BANDS_MAX + b) * 2 + u->chroma], bit);
	mixer_context *const context[INPUTS] = {
		&c->block[0][(((beside * 3 + corners) * 3 + alike) * 3 + near) * 2 + parent],
		&c->block[1][(((b * 3 + alike) * 3 + near) * 3 + others) * 2 + u->chroma],
		&c->block[2][((others * 5 + beside) * 3 + alike) * 2 + parent],
		&c->block[3][(b * 5 + beside) * 3 + corners],
	};
	return mixed_bit(u->coder, decode, context, &c->block_weights[u->chroma * BANDS_MAX + b], bit);
}

static inline __attribute__((always_inline)) uint32_t code_sign(const struct place *u, int decode, uint32_t b, size_t at, uint32_t bit)
{
	struct plane_contexts *c = u->planes->contexts;
	const struct band *band = &u->planes->bands.band[b];
	const uint8_t *s = u->sign + at;
	const ptrdiff_t next = (ptrdiff_t)u->cells, row = band->stride;
	const uint32_t first = u->field ? u->first_sign[at] : 0;
	mixer_context *const context[INPUTS] = {
		&c->sign[0][(s[-1] * 3u + s[-row]) * BANDS_MAX + b],
		&c->sign[1][((s[-2 * next] * 3u + s[2 * next]) * 3 + s[-next]) * 3 + first],
		&c->sign[2][(((s[-1] * 3u + s[1]) * 3 + s[-row]) * 3 + s[row]) * 4 + band->orientation],
		&c->sign[3][(first * 2 + (u->field > 1)) * BANDS_MAX + b],
	};
	return mixed_bit(u->coder, decode, context, &c->sign_weights[u->chroma], bit);
}

/* The parents of row y; NULL where there are none. */
static inline const uint32_t *parent_row(const struct place *u, const struct band *band, uint32_t y)
{
	if (band->parent < 0)
		return NULL;
	const struct band *above = &u->planes->bands.band[band->parent];
	return u->known + above->at + (size_t)(y >> band->parent_shift) * above->stride;
}

/* One level's bit of this plane. */
static inline __attribute__((always_inline)) void code_cell(const struct place *u, int decode, uint32_t b, uint32_t y, uint32_t x, uint32_t fresh,
                                                            const uint32_t *above)
{
	struct plane_contexts *c = u->planes->contexts;
	const struct band *band = &u->planes->bands.band[b];
	const size_t at = band->at + (size_t)y * band->stride + x;
	const ptrdiff_t next = (ptrdiff_t)u->cells, row = band->stride;
	const uint32_t plane = u->plane;
	uint32_t *k = u->known + at;
	const uint32_t left = k[-1], right = k[1], up = k[-row], down = k[row];
	const uint32_t before = k[-next], after = k[next], before2 = k[-2 * next], after2 = k[2 * next];
	const uint32_t around = (2 * (left + right + up + down) + k[-row - 1] + k[-row + 1] + k[row - 1] + k[row + 1]) >> plane;
	const uint32_t along = (2 * (before2 + after2) + before + after) >> plane;
	const uint32_t target = decode ? 0 : (uint32_t)abs(u->level[at]) >> plane;

	if (*k) {
		const uint32_t value = *k >> (plane + 3), tall = value < 4 ? value : value < 8 ? 4 : 5; /* value: the planes above this one */
		mixer_context *const context[INPUTS] = {
			&c->refine[0][tall * SIZES + size_of(around)],
			&c->refine[1][(tall * SIZES + size_of(along)) * 2 + u->chroma],
			&c->refine[2][(tall * BANDS_MAX + b) * SIZES + size_of((around + along) >> 1)],
			&c->refine[3][harmonic_class(u->harmonic) * BANDS_MAX + b],
		};
		const uint32_t bit = mixed_bit(u->coder, decode, context, &c->refine_weights[tall], target & 1);
		*k = (value << 1 | bit) << (plane + 2) | (plane ? 2u << plane : 0);
		return;
	}
	const uint32_t others = (u->other[0][at] + u->other[1][at]) >> plane;
	const uint32_t parent = above ? above[x >> band->parent_shift] >> plane : 0;
	uint32_t bit;
	const uint32_t depth = plane == 0 ? 0 : plane < 3 ? 1 : 2;
	const uint32_t all = size_of((2 * (around + along + parent) + others) >> 1);
	if (all == 0) {
		const uint32_t index = (((harmonic_class(u->harmonic) * BANDS_MAX + b) * 3 + depth) * 2 + u->chroma) * 2 + fresh;
		bit = mixed_bit_alone(u->coder, decode, &c->quiet[index], target);
	} else {
		mixer_context *const context[INPUTS] = {
			&c->zero[0][((size_of(parent) >> 1) * 8 + (size_of(others) >> 1)) * SIZES + all],
			&c->zero[1][(((tier(left, plane) * 3 + tier(up, plane)) * 3 + tier(right, plane)) * 3 + tier(down, plane)) * 4 + band->orientation],
			&c->zero[2][(((tier(before2, plane) * 3 + tier(after2, plane)) * 3 + tier(before, plane)) * 3 + tier(after, plane)) * SIZES + size_of(around)],
			&c->zero[3][(band->row_class[y] * 12u + band->column_class[x]) * SIZES + all],
		};
		bit = mixed_bit(u->coder, decode, context, &c->zero_weights[(u->chroma * BANDS_MAX + b) * 3 + depth], target);
	}
	if (bit) {
		u->sign[at] = (uint8_t)(1 + code_sign(u, decode, b, at, !decode && u->level[at] < 0));
		*k = (4u << plane) | (plane ? 2u << plane : 0);
	}
}

static inline __attribute__((always_inline)) void unit_code(struct planes *p, struct mixed_coder *coder, uint32_t unit, int decode)
{
	const uint32_t harmonics = p->dims.phi_d, field = unit / harmonics % 3, harmonic = unit % harmonics;
	const size_t cell0 = (size_t)(harmonic + 2) * p->bands.cells, block0 = (size_t)(harmonic + 2) * p->bands.blocks;
	const struct place u = {
		.planes = p, .coder = coder, .plane = p->planes - 1 - unit / (3 * harmonics), .field = field, .harmonic = harmonic,
		.chroma = field > 0, .cells = p->bands.cells, .blocks = p->bands.blocks,
		.known = p->known[field] + cell0, .sign = p->sign[field] + cell0, .active = p->active[field] + block0,
		.level = decode ? NULL : p->level[field] + cell0,
		.other = {p->known[field == 0] + cell0, p->known[field == 2 ? 1 : 2] + cell0},
		.first_sign = p->sign[0] + cell0, .first_active = p->active[0] + block0, .second_active = p->active[1] + block0,
	};

	/* The harmonic after the next is new to this plane; blocks of eight columns do not look like a stream to the processor. */
	for (size_t i = 0; i < u.cells; i += 16)
		__builtin_prefetch(u.known + 3 * u.cells + i);
	for (uint32_t b = 0; b < p->bands.count; b++) {
		const struct band *band = &p->bands.band[b];
		const size_t own = band->block_at - band->block_stride - 1; /* the band's flag */
		const uint8_t *top = decode ? NULL : p->top[field] + block0;
		if (!u.active[own]) {
			if (!code_band_flag(&u, decode, b, own, !decode && top[own] > u.plane))
				continue;
			u.active[own] = 1;
		}
		for (uint32_t by = 0; by < band->block_rows; by++)
			for (uint32_t bx = 0; bx < band->block_columns; bx++) {
				const size_t at = band->block_at + (size_t)by * band->block_stride + bx;
				const uint32_t fresh = !u.active[at];
				if (fresh) {
					if (!code_block_flag(&u, decode, b, by, bx, at, !decode && top[at] > u.plane))
						continue;
					u.active[at] = 1;
				}
				const uint32_t y1 = (by + 1) * BLOCK_EDGE < band->rows ? (by + 1) * BLOCK_EDGE : band->rows;
				const uint32_t x1 = (bx + 1) * BLOCK_EDGE < band->columns ? (bx + 1) * BLOCK_EDGE : band->columns;
				for (uint32_t y = by * BLOCK_EDGE; y < y1; y++) {
					const uint32_t *above = parent_row(&u, band, y);
					for (uint32_t x = bx * BLOCK_EDGE; x < x1; x++)
						code_cell(&u, decode, b, y, x, fresh, above);
				}
			}
	}
}

void planes_encode_unit(struct planes *planes, struct mixed_coder *coder, uint32_t unit)
{
	unit_code(planes, coder, unit, 0);
}

void planes_decode_unit(struct planes *planes, struct mixed_coder *coder, uint32_t unit)
{
	/* A copy that nothing else points to can stay in registers. */
	struct mixed_coder own = *coder;
	unit_code(planes, &own, unit, 1);
	*coder = own;
}
