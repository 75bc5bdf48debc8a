/* compact.inc.h: evaluation in the compact form (compact.h). Included after expanded.inc.h, once plain and once for AVX2. */
#include "compact.h"

/* offset and steps in bytes; residual, share: bytes from the block's start; place: between the two share codes */
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
		.share = COMPACT_SHARES + 3 * later,
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

/*
 * The mean of the channels times its weight in each of the four rows (theta_h, theta_d), (., +1), (+1, .), (+1, +1),
 * interpolated along phi_d.
 * The first byte of a pair of residuals is the low one: this form is made and read on little-endian machines only.
 */
static inline f32x4 KERNEL(compact_mean)(const struct lookup *l, const uint8_t *const block[4])
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
	f32x4 mean = KERNEL(compact_mean)(l, (const uint8_t *const[4]){a, b, c, d});

	/* the shares of the four rows at phi_d itself: within a cell their change is far below that of the mean */
	u32x4 from = {KERNEL(load32)(a + l->share), KERNEL(load32)(b + l->share), KERNEL(load32)(c + l->share), KERNEL(load32)(d + l->share)};
	u32x4 to = {KERNEL(load32)(a + l->share + 3), KERNEL(load32)(b + l->share + 3), KERNEL(load32)(c + l->share + 3),
	            KERNEL(load32)(d + l->share + 3)};
	f32x4 red_from = __builtin_convertvector((i32x4)(from & 4095), f32x4), red_to = __builtin_convertvector((i32x4)(to & 4095), f32x4);
	f32x4 blue_from = __builtin_convertvector((i32x4)(from >> 12 & 4095), f32x4);
	f32x4 blue_to = __builtin_convertvector((i32x4)(to >> 12 & 4095), f32x4);
	f32x4 red = ((red_from + (red_to - red_from) * l->place) * t->share_step[0] + t->share_base[0]) * mean;
	f32x4 blue = ((blue_from + (blue_to - blue_from) * l->place) * t->share_step[1] + t->share_base[1]) * mean;
	f32x4 green = mean - red - blue;
	float unit = 3 * t->unit, g = (green[0] + green[1]) + (green[2] + green[3]);
	rgb[0] = ((red[0] + red[1]) + (red[2] + red[3])) * unit;
	rgb[1] = (g > 0 ? g : 0) * unit; /* below 0 by the codes' rounding */
	rgb[2] = ((blue[0] + blue[1]) + (blue[2] + blue[3])) * unit;
}

static inline void KERNEL(compact_mono)(const struct table *t, const struct lookup *l, float rgb[3])
{
	const uint8_t *const a = t->store + l->offset, *const c = a + l->step_h;
	f32x4 mean = KERNEL(compact_mean)(l, (const uint8_t *const[4]){a, a + l->step_d, c, c + l->step_d});
	rgb[0] = rgb[1] = rgb[2] = ((mean[0] + mean[1]) + (mean[2] + mean[3])) * t->unit;
}

TABLE_FORMS(compact_rgb, KERNEL(compact_find), KERNEL(compact_rgb), 1)
TABLE_FORMS(compact_mono, KERNEL(compact_find), KERNEL(compact_mono), 1)

const struct table_kernels KERNEL(table_compact)[2] = {
	{KERNEL(compact_mono_evaluate), KERNEL(compact_mono_nearest), KERNEL(compact_mono_batch)},
	{KERNEL(compact_rgb_evaluate), KERNEL(compact_rgb_nearest), KERNEL(compact_rgb_batch)},
};
