/* compact.inc.h: evaluation in the compact form (compact.h). Included after expanded.inc.h, once plain and once for AVX2. */
#include "compact.h"

/*
 * What a single look-up reads: the blocks of four rows (theta_h, theta_d), (., +1), (+1, .), (+1, +1), bytes within them, and
 * (h, ...) and (meaningless, d, p, place): fractions, and the place between the two share codes.
 */
struct compact_view {
	const uint8_t *a, *b, *c, *d;
	uint32_t residual, share;
	f32x4 h, at;
};

static inline struct compact_view KERNEL(compact_look)(const struct table *t, const struct cell_x4 *cell)
{
	const struct table_place *place = &t->places[cell->k];
	const struct table_pair *rows = &t->rows[cell->j], *slices = &t->slices[cell->i];
	const uint8_t *const first = t->store + rows->offset + place->offset, *const a = first + slices->offset,
						 *const c = a + slices->step;
	f32x4 at = cell->beyond;
	at[3] = place->place + cell->beyond[2] * t->half_reciprocal;
	return (struct compact_view){a, a + rows->step, c, c + rows->step, place->residual, place->share, cell->h, at};
}

/* One of many, without looking anything up: for a loop that vectorises. */
static inline struct lookup KERNEL(compact_find_many)(const struct table *t, struct cell cell)
{
	/* k < 1024, so the product with the reciprocal, rounded up, truncates to the exact quotient */
	uint32_t block = cell.k * t->width_reciprocal >> 16, in = cell.k - block * t->width, later = in >= t->half, odd = cell.j & 1;
	return (struct lookup){
		.offset = t->slice * cell.i + t->row * (cell.j >> 1) + (2 * block + odd) * t->block_bytes,
		.step_h = t->slice & cell.has_h,
		.step_d = (odd ? t->row - t->block_bytes : t->block_bytes) & cell.has_d,
		.residual = COMPACT_RESIDUALS + in,
		.share = COMPACT_SHARES + 3 * later,
		.h = cell.h,
		.d = cell.d,
		.p = cell.p,
		.place = (float)(int32_t)(in - later * t->half) * t->half_reciprocal + cell.p * t->half_reciprocal,
	};
}

static inline uint64_t KERNEL(load64)(const uint8_t *at)
{
	uint64_t value;
	memcpy(&value, at, sizeof value);
	return LOW_FIRST_64(value);
}

static inline uint32_t KERNEL(load32)(const uint8_t *at)
{
	uint32_t value;
	memcpy(&value, at, sizeof value);
	return LOW_FIRST_32(value);
}

static inline uint32_t KERNEL(load16)(const uint8_t *at)
{
	uint16_t value;
	memcpy(&value, at, sizeof value);
	return LOW_FIRST_16(value);
}

/*
 * Lanes of eight hold two values of each of the four rows: those at two cells along phi_d, or two codes. The low byte is first.
 */
static inline void KERNEL(compact_residuals)(const struct compact_view *v, f32x8 *out)
{
	const uint32_t at = v->residual;
#ifdef __AVX2__
	__m128i near = _mm_cvtsi32_si128((int)KERNEL(load32)(v->a + at)), far = _mm_cvtsi32_si128((int)KERNEL(load32)(v->c + at));
	near = _mm_insert_epi16(near, (int16_t)KERNEL(load16)(v->b + at), 1);
	far = _mm_insert_epi16(far, (int16_t)KERNEL(load16)(v->d + at), 1);
	*out = (f32x8)_mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_unpacklo_epi32(near, far)));
#else
	const u32x4 pairs = {KERNEL(load16)(v->a + at), KERNEL(load16)(v->b + at), KERNEL(load16)(v->c + at),
	                     KERNEL(load16)(v->d + at)};
	const f32x4 here = __builtin_convertvector((i32x4)(pairs & 0xff), f32x4),
				next = __builtin_convertvector((i32x4)(pairs >> 8), f32x4);
	*out = __builtin_shufflevector(here, next, 0, 4, 1, 5, 2, 6, 3, 7);
#endif
}

/* The two codes of R and of B at the share's place. Eight bytes are read, from two before: they end within the block. */
static inline void KERNEL(compact_codes)(const struct compact_view *v, f32x8 *red, f32x8 *blue)
{
	const uint32_t at = v->share - 2;
	const uint64_t i = KERNEL(load64)(v->a + at), j = KERNEL(load64)(v->b + at), k = KERNEL(load64)(v->c + at),
				   l = KERNEL(load64)(v->d + at);
#ifdef __AVX2__
	const __m256i spread = _mm256_setr_epi8(-1, 2, 3, 4, -1, 5, 6, 7, -1, 10, 11, 12, -1, 13, 14, 15, /* in each half */
	                                        -1, 2, 3, 4, -1, 5, 6, 7, -1, 10, 11, 12, -1, 13, 14, 15);
	const __m128i near = _mm_set_epi64x((int64_t)j, (int64_t)i), far = _mm_set_epi64x((int64_t)l, (int64_t)k);
	const __m256i both = _mm256_shuffle_epi8(_mm256_set_m128i(far, near), spread);
	*red = (f32x8)_mm256_cvtepi32_ps(_mm256_srli_epi32(_mm256_slli_epi32(both, 12), 20));
	*blue = (f32x8)_mm256_cvtepi32_ps(_mm256_srli_epi32(both, 20));
#else
	const i32x8 both = {(int32_t)(i >> 16 & 0xffffff), (int32_t)(i >> 40), (int32_t)(j >> 16 & 0xffffff), (int32_t)(j >> 40),
	                    (int32_t)(k >> 16 & 0xffffff), (int32_t)(k >> 40), (int32_t)(l >> 16 & 0xffffff), (int32_t)(l >> 40)};
	*red = __builtin_convertvector(both & 4095, f32x8);
	*blue = __builtin_convertvector(both >> 12, f32x8);
#endif
}

/* The 16-bit floats at the starts of the blocks, and those after them. */
static inline void KERNEL(compact_heads)(const struct compact_view *v, f32x8 *base, f32x8 *step)
{
	const u32x4 head = {KERNEL(load32)(v->a), KERNEL(load32)(v->b), KERNEL(load32)(v->c), KERNEL(load32)(v->d)};
#ifdef __AVX2__
	const __m256 both = (__m256)_mm256_slli_epi32(_mm256_cvtepu16_epi32((__m128i)head), COMPACT_HEAD_SHIFT);
	*base = (f32x8)_mm256_moveldup_ps(both);
	*step = (f32x8)_mm256_movehdup_ps(both);
#else
	const f32x4 low = (f32x4)((head & 0xffff) << COMPACT_HEAD_SHIFT), high = (f32x4)(head >> 16 << COMPACT_HEAD_SHIFT);
	*base = __builtin_shufflevector(low, low, 0, 0, 1, 1, 2, 2, 3, 3);
	*step = __builtin_shufflevector(high, high, 0, 0, 1, 1, 2, 2, 3, 3);
#endif
}

static inline void KERNEL(join)(f32x4 low, f32x4 high, f32x8 *out)
{
#ifdef __AVX2__ /* one instruction, of which gcc 12 makes three */
	*out = (f32x8)_mm256_set_m128((__m128)high, (__m128)low);
#else
	*out = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#endif
}

/* The sum of the rows of theta_h and those of the next. */
static inline f32x4 KERNEL(halves)(const f32x8 *v)
{
#ifdef __AVX2__
	return (f32x4)_mm256_castps256_ps128((__m256)*v) + (f32x4)_mm256_extractf128_ps((__m256)*v, 1);
#else
	return __builtin_shufflevector(*v, *v, 0, 1, 2, 3) + __builtin_shufflevector(*v, *v, 4, 5, 6, 7);
#endif
}

/* The mean of the channels times its weight; and (1 - p, p, 1 - place, place). */
static inline f32x4 KERNEL(compact_mean)(const struct compact_view *v, f32x8 *out)
{
	const f32x4 one = {1, 1, 1, 1}, to = v->at, from = one - to, h = __builtin_shufflevector(v->h, v->h, 0, 0, 0, 0);
	const f32x4 along = __builtin_shufflevector(from, to, 2, 6, 3, 7), across = __builtin_shufflevector(from, to, 1, 1, 5, 5);
	const f32x4 weight = across * __builtin_shufflevector(along, along, 0, 1, 0, 1);
	f32x8 residual, base, step, both;
	KERNEL(join)(weight * (one - h), weight * h, &both);
	KERNEL(compact_residuals)(v, &residual);
	KERNEL(compact_heads)(v, &base, &step);
	f32x8 root = base + step * residual;
	root *= root;
	*out = root * root * both;
	return along;
}

static inline void KERNEL(compact_rgb)(const struct table *t, const struct compact_view *v, float rgb[3])
{
	f32x8 mean, place, red, blue;
	const f32x4 along = KERNEL(compact_mean)(v, &mean), ends = __builtin_shufflevector(along, along, 2, 3, 2, 3);
	KERNEL(join)(ends, ends, &place);
	KERNEL(compact_codes)(v, &red, &blue);
	/* the shares of the four rows are taken at phi_d itself: within a cell their change is far below that of the mean */
	const f32x8 weight = (mean + __builtin_shufflevector(mean, mean, 1, 0, 3, 2, 5, 4, 7, 6)) * place;
	red *= weight;
	blue *= weight;
	const f32x4 r = KERNEL(halves)(&red), g = KERNEL(halves)(&mean), u = KERNEL(halves)(&blue);
	const f32x4 pair = __builtin_shufflevector(r, u, 0, 4, 1, 5) + __builtin_shufflevector(r, u, 2, 6, 3, 7);
	const f32x4 codes_sum = pair + __builtin_shufflevector(pair, pair, 2, 3, 2, 3);
	const f32x4 two = g + __builtin_shufflevector(g, g, 2, 3, 2, 3), sum = two + __builtin_shufflevector(two, two, 1, 1, 1, 1);
	const f32x4 value = __builtin_shufflevector(codes_sum, codes_sum, 0, 0, 0, 0) * t->mix[0] +
	                    __builtin_shufflevector(codes_sum, codes_sum, 1, 1, 1, 1) * t->mix[1] +
	                    __builtin_shufflevector(sum, sum, 0, 0, 0, 0) * t->mix[2];
	const f32x4 out = max_x4(value, (f32x4){0, 0, 0, 0}); /* green below 0 by the codes' rounding */
	rgb[0] = out[0];
	rgb[1] = out[1];
	rgb[2] = out[2];
}

static inline void KERNEL(compact_mono)(const struct table *t, const struct compact_view *v, float rgb[3])
{
	f32x8 mean;
	(void)KERNEL(compact_mean)(v, &mean);
	const f32x4 m = KERNEL(halves)(&mean);
	rgb[0] = rgb[1] = rgb[2] = ((m[0] + m[2]) + (m[1] + m[3])) * t->unit;
}

static inline void KERNEL(compact_rgb_one)(const struct table *t, const struct cell_x4 *cell, float rgb[3])
{
	const struct compact_view v = KERNEL(compact_look)(t, cell);
	KERNEL(compact_rgb)(t, &v, rgb);
}

static inline void KERNEL(compact_mono_one)(const struct table *t, const struct cell_x4 *cell, float rgb[3])
{
	const struct compact_view v = KERNEL(compact_look)(t, cell);
	KERNEL(compact_mono)(t, &v, rgb);
}

static inline void KERNEL(compact_mono_of_many)(const struct table *t, const struct lookup *l, float rgb[3])
{
	const uint8_t *const a = t->store + l->offset, *const c = a + l->step_h;
	const struct compact_view v = {a, a + l->step_d, c, c + l->step_d, l->residual, 0, {l->h, 0, 0, 0}, {0, l->d, l->p, 0}};
	KERNEL(compact_mono)(t, &v, rgb);
}

/* What many look-ups read, by row (as the lanes above): scattered bytes first, then loops that vectorise. */
struct compact_gathered {
	uint32_t head[4][BLOCK], residual[4][BLOCK]; /* the residuals in the low two bytes */
	uint32_t from[4][BLOCK], to[4][BLOCK];       /* the codes in the high 24 bits */
};

static inline void KERNEL(compact_gather)(const struct table *t, const struct lookups *l, const struct lookups *next,
                                          struct compact_gathered *out)
{
	for (size_t m = 0; m < l->count; m++) {
		KERNEL(fetch)(t, next, m, 1);
		const uint8_t *block[4] = {t->store + l->offset[m]};
		const uint32_t residual = l->residual[m], share = l->share[m];
		block[1] = block[0] + l->step_d[m];
		block[2] = block[0] + l->step_h[m];
		block[3] = block[2] + l->step_d[m];
		for (int r = 0; r < 4; r++) {
			out->head[r][m] = KERNEL(load32)(block[r]);
			out->residual[r][m] = KERNEL(load16)(block[r] + residual);
			out->from[r][m] = KERNEL(load32)(block[r] + share - 1);
			out->to[r][m] = KERNEL(load32)(block[r] + share + 2);
		}
	}
}

/* Of one row: the mean times its weight at the two cells, and the weighted sums of codes. */
struct compact_row_value {
	float here, next, red_from, red_to, blue_from, blue_to;
};

static inline struct compact_row_value KERNEL(compact_row_value)(uint32_t head, uint32_t residual, uint32_t from, uint32_t to,
                                                                 float weight_here, float weight_next, float place)
{
	float base = float_of_bits((head & 0xffff) << COMPACT_HEAD_SHIFT), step = float_of_bits(head >> 16 << COMPACT_HEAD_SHIFT);
	float here = base + step * (float)(int32_t)(residual & 0xff), next = base + step * (float)(int32_t)(residual >> 8);
	here *= here;
	next *= next;
	here = here * here * weight_here;
	next = next * next * weight_next;
	float mean = here + next, weight_from = mean * (1 - place), weight_to = mean * place;
	return (struct compact_row_value){here,
	                                  next,
	                                  (float)(int32_t)(from >> 8 & 4095) * weight_from,
	                                  (float)(int32_t)(to >> 8 & 4095) * weight_to,
	                                  (float)(int32_t)(from >> 20) * weight_from,
	                                  (float)(int32_t)(to >> 20) * weight_to};
}

/* compact_rgb for many, in the same order of operations. */
static inline void KERNEL(compact_rgb_values)(const struct table *t, const struct lookups *l, const struct lookups *next,
                                              float *restrict red, float *restrict green, float *restrict blue)
{
	const float mix[3][3] = {{t->mix[0][0], t->mix[0][1], t->mix[0][2]},
	                         {t->mix[1][0], t->mix[1][1], t->mix[1][2]},
	                         {t->mix[2][0], t->mix[2][1], t->mix[2][2]}};
	struct compact_gathered in;
	KERNEL(compact_gather)(t, l, next, &in);
	for (size_t m = 0, n = l->count; m < n; m++) {
		float h1 = l->h[m], h0 = 1 - h1, d1 = l->d[m], d0 = 1 - d1, p1 = l->p[m], p0 = 1 - p1, place = l->place[m];
		struct compact_row_value a, b, c, d;
		a = KERNEL(compact_row_value)(in.head[0][m], in.residual[0][m], in.from[0][m], in.to[0][m], d0 * p0 * h0, d0 * p1 * h0,
		                              place);
		b = KERNEL(compact_row_value)(in.head[1][m], in.residual[1][m], in.from[1][m], in.to[1][m], d1 * p0 * h0, d1 * p1 * h0,
		                              place);
		c = KERNEL(compact_row_value)(in.head[2][m], in.residual[2][m], in.from[2][m], in.to[2][m], d0 * p0 * h1, d0 * p1 * h1,
		                              place);
		d = KERNEL(compact_row_value)(in.head[3][m], in.residual[3][m], in.from[3][m], in.to[3][m], d1 * p0 * h1, d1 * p1 * h1,
		                              place);
		float r = ((a.red_from + c.red_from) + (b.red_from + d.red_from)) + ((a.red_to + c.red_to) + (b.red_to + d.red_to));
		float u =
			((a.blue_from + c.blue_from) + (b.blue_from + d.blue_from)) + ((a.blue_to + c.blue_to) + (b.blue_to + d.blue_to));
		float g = ((a.here + c.here) + (b.here + d.here)) + ((a.next + c.next) + (b.next + d.next));
		float value[3];
		for (int k = 0; k < 3; k++) {
			value[k] = r * mix[0][k] + u * mix[1][k] + g * mix[2][k];
			value[k] = value[k] > 0 ? value[k] : 0;
		}
		red[m] = value[0];
		green[m] = value[1];
		blue[m] = value[2];
	}
}

static const struct KERNEL(form)
	KERNEL(compact_rgb_form) = {KERNEL(compact_rgb_one), KERNEL(compact_find_many), NULL, KERNEL(compact_rgb_values), 1, true};
static const struct KERNEL(form) KERNEL(compact_mono_form) = {
	KERNEL(compact_mono_one), KERNEL(compact_find_many), KERNEL(compact_mono_of_many), NULL, 1, true};
FORM_ENTRIES(compact_rgb_form)
FORM_ENTRIES(compact_mono_form)

const struct table_kernels KERNEL(table_compact)[2] = {
	{KERNEL(compact_mono_form_evaluate), KERNEL(compact_mono_form_nearest), KERNEL(compact_mono_form_batch)},
	{KERNEL(compact_rgb_form_evaluate), KERNEL(compact_rgb_form_nearest), KERNEL(compact_rgb_form_batch)},
};
