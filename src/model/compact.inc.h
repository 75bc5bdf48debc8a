/* compact.inc.h: evaluation in the compact form (compact.h). Included after expanded.inc.h, once plain and once for AVX2. */
#include "compact.h"

typedef int32_t i32x8 __attribute__((vector_size(32)));

/* offset and steps in bytes; residual, ratio: bytes from the block's start; place: between the two ratio codes */
static inline struct lookup KERNEL(compact_find)(const struct table *t, struct cell cell)
{
	/* k < 1024, so the product with the reciprocal, rounded up, truncates to the exact quotient */
	uint32_t k = (uint32_t)cell.k, block = k * t->width_reciprocal >> 16, in = k - block * t->width;
	uint32_t later = in >= t->half;
	return (struct lookup){
		.offset = t->row * ((uint32_t)cell.j + t->dims.theta_d * (uint32_t)cell.i) + block * t->block_bytes,
		.step_h = (uint32_t)cell.i + 1 < t->dims.theta_h ? t->row * t->dims.theta_d : 0,
		.step_d = (uint32_t)cell.j + 1 < t->dims.theta_d ? t->row : 0,
		.residual = COMPACT_RESIDUALS + in,
		.ratio = COMPACT_RATIOS + 3 * later,
		.h = cell.h,
		.d = cell.d,
		.p = cell.p,
		.place = ((float)(int32_t)(in - later * t->half) + cell.p) * t->half_reciprocal,
	};
}

static inline uint32_t KERNEL(load32)(const uint8_t *at)
{
	uint32_t value;
	memcpy(&value, at, sizeof value);
	return value;
}

static inline uint32_t KERNEL(load16)(const uint8_t *at)
{
	uint16_t value;
	memcpy(&value, at, sizeof value);
	return value;
}

/* 2^x for |x| <= 24; relative error below 3e-7 */
static inline void KERNEL(exp2_lanes)(f32x8 *x)
{
	const float magic = 12582912.0f; /* 1.5 2^23: rounds to an integer in the low bits */
	f32x8 shifted = *x + magic, f = *x - (shifted - magic);
	f32x8 p = 0.00133335581f * f + 0.00961812911f;
	p = p * f + 0.0555041087f;
	p = p * f + 0.240226507f;
	p = p * f + 0.693147181f;
	p = p * f + 1;
	*x = p * (f32x8)(((u32x8)shifted + 127) << 23);
}

/*
 * G times its weight in each of the four rows (theta_h, theta_d), (., +1), (+1, .), (+1, +1), interpolated along phi_d.
 * The first byte of a pair of residuals is the low one: this form is made and read on little-endian machines only.
 */
static inline f32x4 KERNEL(compact_green)(const struct lookup *l, const uint8_t *const block[4])
{
	uint32_t h0 = KERNEL(load32)(block[0]), h1 = KERNEL(load32)(block[1]), h2 = KERNEL(load32)(block[2]), h3 = KERNEL(load32)(block[3]);
	uint32_t r0 = KERNEL(load16)(block[0] + l->residual), r1 = KERNEL(load16)(block[1] + l->residual);
	uint32_t r2 = KERNEL(load16)(block[2] + l->residual), r3 = KERNEL(load16)(block[3] + l->residual);
	u32x4 head = {h0, h1, h2, h3}, residual = {r0, r1, r2, r3};
	/* 2^64: see DECODE_SCALE */
	f32x4 base = (f32x4)((head & 0xffff) << 13) * DECODE_SCALE, step = (f32x4)(head >> 16 << 13) * DECODE_SCALE;
	f32x4 here = base + step * __builtin_convertvector((i32x4)(residual & 0xff), f32x4);
	f32x4 next = base + step * __builtin_convertvector((i32x4)(residual >> 8), f32x4);
	float a1 = l->h, a0 = 1 - a1, d1 = l->d, d0 = 1 - d1, p1 = l->p, p0 = 1 - p1;
	here *= here;
	next *= next;
	return (here * here * p0 + next * next * p1) * ((f32x4){a0, a0, a1, a1} * (f32x4){d0, d1, d0, d1});
}

static inline void KERNEL(compact_rgb)(const struct table *t, const struct lookup *l, float rgb[3])
{
	const uint8_t *const a = t->store + l->offset, *const b = a + l->step_d, *const c = a + l->step_h, *const d = c + l->step_d;
	f32x4 green = KERNEL(compact_green)(l, (const uint8_t *const[4]){a, b, c, d});

	/* R/G of the four rows, then B/G, at phi_d itself: within a cell the ratios' change is far below their steps */
	uint32_t a0 = KERNEL(load32)(a + l->ratio), b0 = KERNEL(load32)(b + l->ratio);
	uint32_t c0 = KERNEL(load32)(c + l->ratio), d0 = KERNEL(load32)(d + l->ratio);
	uint32_t a1 = KERNEL(load32)(a + l->ratio + 3), b1 = KERNEL(load32)(b + l->ratio + 3);
	uint32_t c1 = KERNEL(load32)(c + l->ratio + 3), d1 = KERNEL(load32)(d + l->ratio + 3);
	u32x8 from = {a0, b0, c0, d0, a0 >> 12, b0 >> 12, c0 >> 12, d0 >> 12}, to = {a1, b1, c1, d1, a1 >> 12, b1 >> 12, c1 >> 12, d1 >> 12};
	f32x8 from_code = __builtin_convertvector((i32x8)(from & 4095), f32x8), to_code = __builtin_convertvector((i32x8)(to & 4095), f32x8);
	float sr = t->ratio_step[0], sb = t->ratio_step[1], br = t->ratio_base[0], bb = t->ratio_base[1];
	f32x8 ratio = (from_code + (to_code - from_code) * l->place) * (f32x8){sr, sr, sr, sr, sb, sb, sb, sb} + (f32x8){br, br, br, br, bb, bb, bb, bb};
	KERNEL(exp2_lanes)(&ratio);
	f32x8 colour = ratio * (f32x8){green[0], green[1], green[2], green[3], green[0], green[1], green[2], green[3]};
	rgb[0] = ((colour[0] + colour[1]) + (colour[2] + colour[3])) * t->unit;
	rgb[1] = ((green[0] + green[1]) + (green[2] + green[3])) * t->unit;
	rgb[2] = ((colour[4] + colour[5]) + (colour[6] + colour[7])) * t->unit;
}

static inline void KERNEL(compact_mono)(const struct table *t, const struct lookup *l, float rgb[3])
{
	const uint8_t *const a = t->store + l->offset, *const c = a + l->step_h;
	f32x4 mean = KERNEL(compact_green)(l, (const uint8_t *const[4]){a, a + l->step_d, c, c + l->step_d});
	rgb[0] = rgb[1] = rgb[2] = ((mean[0] + mean[1]) + (mean[2] + mean[3])) * t->unit;
}

TABLE_FORMS(compact_rgb, KERNEL(compact_find), KERNEL(compact_rgb), 1)
TABLE_FORMS(compact_mono, KERNEL(compact_find), KERNEL(compact_mono), 1)

const struct table_kernels KERNEL(table_compact)[2] = {
	{KERNEL(compact_mono_evaluate), KERNEL(compact_mono_nearest), KERNEL(compact_mono_batch)},
	{KERNEL(compact_rgb_evaluate), KERNEL(compact_rgb_nearest), KERNEL(compact_rgb_batch)},
};
