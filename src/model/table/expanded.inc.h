/*
 * expanded.inc.h: evaluation in the expanded form; included once plain and once for AVX2, with
 * KERNEL(name) defined. The arithmetic is the same in both.
 *
 * A stored 16-bit float shifted left by 13 is the bit pattern of a float that is 2^-64 of the
 * value: decoding costs one shift, and the 2^64 is in the weights.
 */
#include <string.h>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "locate.inc.h"

typedef uint16_t u16x8 __attribute__((vector_size(16)));
typedef uint32_t u32x8 __attribute__((vector_size(32)));
typedef int32_t i32x8 __attribute__((vector_size(32)));
typedef float f32x8 __attribute__((vector_size(32)));
typedef uint16_t u16x4 __attribute__((vector_size(8)));
typedef uint32_t u32x4 __attribute__((vector_size(16)));

#define DECODE_SCALE 0x1p64f

static inline struct lookup KERNEL(expanded_find)(const struct table *t, struct cell cell)
{
	return (struct lookup){
		.offset = t->slice * cell.i + t->row * cell.j + (uint32_t)t->channels * cell.k,
		.step_h = t->slice & cell.has_h,
		.step_d = t->row & cell.has_d,
		.h = cell.h,
		.d = cell.d,
		.p = cell.p,
	};
}

/* R G B at phi_d, R G B at the next phi_d, and two values that are not used; times a weight. By pointer, as in vector.h. */
static inline void KERNEL(row)(const uint16_t *cell, float weight, f32x8 *out)
{
	u16x8 packed;
	memcpy(&packed, cell, sizeof packed);
#ifdef __AVX2__ /* one instruction, of which gcc 12 makes four */
	u32x8 wide = (u32x8)_mm256_cvtepu16_epi32((__m128i)packed);
#else
	u32x8 wide = __builtin_convertvector(packed, u32x8);
#endif
	*out = (f32x8)(wide << 13) * weight;
}

static inline void KERNEL(expanded_rgb)(const struct table *t, const struct lookup *l, float rgb[3])
{
	const uint16_t *cell = (const uint16_t *)(const void *)t->store + l->offset, *above = cell + l->step_h;
	float h1 = l->h * DECODE_SCALE, h0 = DECODE_SCALE - h1, d1 = l->d, d0 = 1 - d1, p1 = l->p * t->unit, p0 = t->unit - p1;
	f32x8 a, b, c, d;
	KERNEL(row)(cell, h0 * d0, &a);
	KERNEL(row)(cell + l->step_d, h0 * d1, &b);
	KERNEL(row)(above, h1 * d0, &c);
	KERNEL(row)(above + l->step_d, h1 * d1, &d);
	const f32x8 sum = (a + b) + (c + d);
	f32x4 low = __builtin_shufflevector(sum, sum, 0, 1, 2, 3) * p0, high = __builtin_shufflevector(sum, sum, 3, 4, 5, 6) * p1;
	f32x4 value = low + high;
	rgb[0] = value[0];
	rgb[1] = value[1];
	rgb[2] = value[2];
}

static inline void KERNEL(expanded_mono)(const struct table *t, const struct lookup *l, float rgb[3])
{
	const uint16_t *a = (const uint16_t *)(const void *)t->store + l->offset, *b = a + l->step_d, *c = a + l->step_h,
				   *d = b + l->step_h;
	float h1 = l->h * DECODE_SCALE, h0 = DECODE_SCALE - h1, d1 = l->d, d0 = 1 - d1, p1 = l->p * t->unit, p0 = t->unit - p1;
	u16x4 low = {a[0], a[1], b[0], b[1]}, high = {c[0], c[1], d[0], d[1]};
	f32x4 weight = {d0, d0, d1, d1};
	f32x4 sum = (f32x4)(__builtin_convertvector(low, u32x4) << 13) * (h0 * weight);
	sum += (f32x4)(__builtin_convertvector(high, u32x4) << 13) * (h1 * weight);
	rgb[0] = rgb[1] = rgb[2] = (sum[0] + sum[2]) * p0 + (sum[1] + sum[3]) * p1;
}

static inline struct lookup KERNEL(expanded_look)(const struct table *t, const struct cell_x4 *at)
{
	const struct table_pair slice = t->slices[at->i], row = t->rows[at->j];
	return (struct lookup){
		.offset = slice.offset + row.offset + t->places[at->k].offset,
		.step_h = slice.step,
		.step_d = row.step,
		.h = at->h[0],
		.d = at->beyond[1],
		.p = at->beyond[2],
	};
}

static inline void KERNEL(expanded_rgb_one)(const struct table *t, const struct cell_x4 *at, float rgb[3])
{
	const struct lookup l = KERNEL(expanded_look)(t, at);
	KERNEL(expanded_rgb)(t, &l, rgb);
}

static inline void KERNEL(expanded_mono_one)(const struct table *t, const struct cell_x4 *at, float rgb[3])
{
	const struct lookup l = KERNEL(expanded_look)(t, at);
	KERNEL(expanded_mono)(t, &l, rgb);
}

static const struct KERNEL(form) KERNEL(expanded_rgb_form) = {
	KERNEL(expanded_rgb_one), KERNEL(expanded_find), KERNEL(expanded_rgb), NULL, sizeof(uint16_t), false};
static const struct KERNEL(form) KERNEL(expanded_mono_form) = {
	KERNEL(expanded_mono_one), KERNEL(expanded_find), KERNEL(expanded_mono), NULL, sizeof(uint16_t), false};
FORM_ENTRIES(expanded_rgb_form)
FORM_ENTRIES(expanded_mono_form)

const struct table_kernels KERNEL(table_expanded)[2] = {
	{KERNEL(expanded_mono_form_evaluate), KERNEL(expanded_mono_form_nearest), KERNEL(expanded_mono_form_batch)},
	{KERNEL(expanded_rgb_form_evaluate), KERNEL(expanded_rgb_form_nearest), KERNEL(expanded_rgb_form_batch)},
};
