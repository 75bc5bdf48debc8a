/* compact_row.inc.h: rows of values become blocks of the compact form. See compact.h. */
#include "compact.h"
#include "model/math/fast_math.h"

static inline f32x4 KERNEL(load4)(const float *p)
{
	f32x4 v;
	memcpy(&v, p, sizeof v);
	return v;
}

static inline float KERNEL(sum4)(f32x4 v) { return (v[0] + v[1]) + (v[2] + v[3]); }

/* The codes of both shares; a cell's errors count 1e-6 to 1: little where it is dark. */
static void KERNEL(compact_fit_weighted)(const struct compact_hats *hats, const float *const share[2], const float *mean,
                                         float dark, float *const codes[2])
{
	f32x4 system[5] = {{0}}, right[2][3] = {{{0}}};
	float m[5];
	for (uint32_t k = 0; k < CELLS_MAX; k += 4) {
		const f32x4 m4 = KERNEL(load4)(mean + k), bright = m4 / (m4 + dark), w = bright * bright + 1e-6f;
		for (int n = 0; n < 5; n++)
			system[n] += w * KERNEL(load4)(hats->product[n] + k);
		for (int c = 0; c < 2; c++) {
			const f32x4 weighed = w * KERNEL(load4)(share[c] + k);
			for (int a = 0; a < 3; a++)
				right[c][a] += weighed * KERNEL(load4)(hats->h[a] + k);
		}
	}
	for (int n = 0; n < 5; n++)
		m[n] = KERNEL(sum4)(system[n]) * (n % 2 ? 1 : 1.0001f); /* where only dark cells lie under a hat */
	for (int c = 0; c < 2; c++) {
		for (int a = 0; a < 3; a++)
			codes[c][a] = KERNEL(sum4)(right[c][a]);
		compact_solve(m, codes[c]);
	}
}

/* The least and the largest of 4 values or more. */
static inline void KERNEL(compact_range)(const float *x, uint32_t count, float *least, float *largest)
{
	f32x4 low = KERNEL(load4)(x), high = low;
	for (uint32_t k = 4; k < count; k += 4) {
		const f32x4 v = KERNEL(load4)(x + (k + 4 <= count ? k : count - 4));
		low = min_x4(v, low);
		high = max_x4(v, high);
	}
	low = min_x4(low, __builtin_shufflevector(low, low, 2, 3, 0, 1));
	high = max_x4(high, __builtin_shufflevector(high, high, 2, 3, 0, 1));
	*least = low[0] < low[1] ? low[0] : low[1];
	*largest = high[0] > high[1] ? high[0] : high[1];
}

/* The three codes of a block's shares, within the range of the shares themselves. */
static void KERNEL(compact_fit)(const struct compact_hats *hats, const float *const share[2], const float *mean, float dark,
                                float *const codes[2])
{
	const float STEEP = 0.02f; /* from this range within a block on, dark cells may mislead the plain fit */
	float low[2], high[2];
	for (int c = 0; c < 2; c++)
		KERNEL(compact_range)(share[c], hats->width + 1, &low[c], &high[c]);
	if (high[0] == low[0] && high[1] == low[1]) { /* as everywhere below the horizon; what follows would end in the same */
		for (int c = 0; c < 2; c++)
			codes[c][0] = codes[c][1] = codes[c][2] = low[c];
		return;
	}
	if (high[0] - low[0] > STEEP || high[1] - low[1] > STEEP) {
		KERNEL(compact_fit_weighted)(hats, share, mean, dark, codes);
	} else {
		f32x4 sum[2][3] = {{{0}}};
		for (uint32_t k = 0; k < CELLS_MAX; k += 4) {
			const f32x4 red = KERNEL(load4)(share[0] + k), blue = KERNEL(load4)(share[1] + k);
			for (int a = 0; a < 3; a++) {
				const f32x4 fit = KERNEL(load4)(hats->fit[a] + k);
				sum[0][a] += red * fit;
				sum[1][a] += blue * fit;
			}
		}
		for (int c = 0; c < 2; c++)
			for (int a = 0; a < 3; a++)
				codes[c][a] = KERNEL(sum4)(sum[c][a]);
	}
	for (int c = 0; c < 2; c++)
		for (int a = 0; a < 3; a++)
			codes[c][a] = codes[c][a] > low[c] ? (codes[c][a] < high[c] ? codes[c][a] : high[c]) : low[c];
}

/* Not inline: there gcc forgets that nothing overlaps, and does not vectorise. */
__attribute__((noinline)) static void KERNEL(compact_means)(const float *restrict red, const float *restrict green,
                                                            const float *restrict blue, uint32_t width, float third,
                                                            float *restrict root, float *restrict r_share,
                                                            float *restrict b_share, float *restrict means)
{
	for (uint32_t k = 0; k < width; k++) {
		float r = red[k] * third, b = blue[k] * third, mean = r + green[k] * third + b;
		bool black = mean < 0x1p-120f;
		float per = 1 / (black ? 1 : mean);
		r_share[k] = black ? 1.0f / 3 : r * per;
		b_share[k] = black ? 1.0f / 3 : b * per;
		means[k] = mean;
		root[k] = sqrtf(sqrtf(mean));
	}
}

static void KERNEL(compact_prepare)(const struct compact_rows_plan *plan, const float *const rgb[3])
{
	const uint32_t width = plan->period, padded = plan->padded;
	const struct compact_row *out = &plan->row;

	KERNEL(compact_means)(rgb[0], rgb[1], rgb[2], width, plan->third, out->root, out->share[0], out->share[1], out->mean);
	for (uint32_t k = width; k < padded; k++) {
		out->root[k] = out->root[k - width];
		for (int c = 0; c < 2 && plan->channels == 3; c++)
			out->share[c][k] = out->share[c][k - width];
		if (plan->channels == 3)
			out->mean[k] = out->mean[k - width];
	}
}

static void KERNEL(compact_roots)(const float *root, uint32_t count, uint8_t *block)
{
	float low, high;
	KERNEL(compact_range)(root, count, &low, &high);
	/* the base rounded down, the step up: their range holds every value */
	uint16_t base = (uint16_t)(bits_of_float(low) >> COMPACT_HEAD_SHIFT);
	float from = float_of_bits((uint32_t)base << COMPACT_HEAD_SHIFT);
	uint16_t step =
		(uint16_t)((bits_of_float((high - from) * (1.0f / 255)) + (1u << COMPACT_HEAD_SHIFT) - 1) >> COMPACT_HEAD_SHIFT);
	float width = float_of_bits((uint32_t)step << COMPACT_HEAD_SHIFT), per = width > 0x1p-120f ? 1 / width : 0;
	const uint16_t head[2] = {LOW_FIRST_16(base), LOW_FIRST_16(step)};
	memcpy(block, head, sizeof head);
	/* What lies past the count means nothing: the shares' codes come there, or nobody reads it. */
	i32x4 code[CELLS_MAX / 4];
	for (int k = 0; k < CELLS_MAX / 4; k++) {
		const f32x4 near = (KERNEL(load4)(root + 4 * k) - from) * per + 0.5f;
		code[k] = __builtin_convertvector(min_x4(max_x4(near, (f32x4){0, 0, 0, 0}), (f32x4){255, 255, 255, 255}), i32x4);
	}
#ifdef __SSE2__ /* gcc 12 makes four times as many instructions of it */
	const __m128i low4 = _mm_packs_epi32((__m128i)code[0], (__m128i)code[1]),
				  next4 = _mm_packs_epi32((__m128i)code[2], (__m128i)code[3]);
	const __m128i first = _mm_packus_epi16(low4, next4),
				  rest = _mm_packus_epi16(_mm_packs_epi32((__m128i)code[4], (__m128i)code[4]), next4);
	memcpy(block + COMPACT_RESIDUALS, &first, 16);
	memcpy(block + COMPACT_RESIDUALS + 16, &rest, 4);
#else
	for (int k = 0; k < CELLS_MAX; k++)
		block[COMPACT_RESIDUALS + k] = (uint8_t)code[k / 4][k % 4];
#endif
}
_Static_assert(CELLS_MAX == 20 && COMPACT_RESIDUALS + CELLS_MAX <= COMPACT_BLOCK_MONO,
               "a block has room for all that is written");

void KERNEL(compact_row)(const struct compact_rows_plan *plan, const float *const rgb[3], uint8_t *block, float *const knots[2])
{
	KERNEL(compact_prepare)(plan, rgb);
	for (uint32_t b = 0; b < plan->blocks; b++, block += 2 * plan->block_bytes) {
		const uint32_t first = b * plan->width;
		KERNEL(compact_roots)(plan->row.root + first, plan->width + 1, block);
		if (plan->channels != 3)
			continue;
		const float *const share[2] = {plan->row.share[0] + first, plan->row.share[1] + first};
		float *const codes[2] = {knots[0] + 3 * b, knots[1] + 3 * b};
		KERNEL(compact_fit)(&plan->hats, share, plan->row.mean + first, plan->dark, codes);
	}
}
