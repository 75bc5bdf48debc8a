#include "compact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "../memory.h"

/* A row as the blocks want it: `padded` values, those past the row's end being its first ones again. */
struct compact_row {
	float *root;     /* fourth root of the mean of the channels, in [0, 1] */
	float *share[2]; /* R and B as shares of the sum; 1/3 where the cell is black */
	float *mean;     /* of the channels, in [0, 1] */
};

/* Cells 0..width of a block, and what makes them a whole number of vectors: read, but of no weight. */
enum { CELLS_MAX = (COMPACT_WIDTH_MAX + 1 + 3) / 4 * 4 };

typedef int32_t mask4 __attribute__((vector_size(16)));

static inline f32x4 load4(const float *p)
{
	f32x4 v;
	memcpy(&v, p, sizeof v);
	return v;
}

static inline float sum4(f32x4 v)
{
	return (v[0] + v[1]) + (v[2] + v[3]);
}

/* Shares of cells well below this count little: 1e-3/sr, as a share of the table's largest value, within reason. */
static float dark_of(double largest)
{
	double dark = 1e-3 / largest;
	return (float)(dark < 0x1p-11 ? fmax(dark, 0x1p-31) : 0x1p-11);
}

/*
 * Hat functions h at cells 0, half and 2 half; 0 past the width. Those at 0 and at 2 half do not meet, so least squares are a
 * tridiagonal system. Every hat function has a cell of its own as long as width > half (a block of MERL has 18 and 9).
 */
struct hats {
	uint32_t width, half;
	float h[3][CELLS_MAX];
	float product[5][CELLS_MAX]; /* h0 h0, h0 h1, h1 h1, h1 h2, h2 h2 */
	float fit[3][CELLS_MAX];     /* the codes for weights that are all alike: sums of fit times share */
};

/* m: the five different elements of the system; x: its right-hand side, then its solution. */
static void solve(const float m[5], float x[3])
{
	const float up = m[1] / m[0], middle = m[2] - up * m[1], down = m[3] / middle;
	x[1] -= up * x[0];
	x[2] = (x[2] - down * x[1]) / (m[4] - down * m[3]);
	x[1] = (x[1] - m[3] * x[2]) / middle;
	x[0] = (x[0] - m[1] * x[1]) / m[0];
}

static void hats_make(uint32_t width, uint32_t half, struct hats *out)
{
	float system[5] = {0};
	memset(out, 0, sizeof *out);
	out->width = width;
	out->half = half;
	for (uint32_t k = 0; k <= width; k++) {
		uint32_t m = k < half ? 0 : 1;
		float t = (float)(k - m * half) / (float)half;
		out->h[m][k] = 1 - t;
		out->h[m + 1][k] = t;
	}
	for (int n = 0; n < 5; n++)
		for (uint32_t k = 0; k <= width; k++) {
			out->product[n][k] = out->h[n / 2][k] * out->h[(n + 1) / 2][k];
			system[n] += out->product[n][k];
		}
	for (uint32_t k = 0; k <= width; k++) {
		float x[3] = {out->h[0][k], out->h[1][k], out->h[2][k]};
		solve(system, x);
		for (int a = 0; a < 3; a++)
			out->fit[a][k] = x[a];
	}
}

/* The codes of both shares; a cell's errors count 1e-6 to 1: little where it is dark. */
static void fit_weighted(const struct hats *hats, const float *const share[2], const float *mean, float dark, float *const codes[2])
{
	f32x4 system[5] = {{0}}, right[2][3] = {{{0}}};
	float m[5];
	for (uint32_t k = 0; k < CELLS_MAX; k += 4) {
		const f32x4 m4 = load4(mean + k), bright = m4 / (m4 + dark), w = bright * bright + 1e-6f;
		for (int n = 0; n < 5; n++)
			system[n] += w * load4(hats->product[n] + k);
		for (int c = 0; c < 2; c++) {
			const f32x4 weighed = w * load4(share[c] + k);
			for (int a = 0; a < 3; a++)
				right[c][a] += weighed * load4(hats->h[a] + k);
		}
	}
	for (int n = 0; n < 5; n++)
		m[n] = sum4(system[n]) * (n % 2 ? 1 : 1.0001f); /* where only dark cells lie under a hat */
	for (int c = 0; c < 2; c++) {
		for (int a = 0; a < 3; a++)
			codes[c][a] = sum4(right[c][a]);
		solve(m, codes[c]);
	}
}

/* The least and the largest of 4 values or more. */
static inline void range_find(const float *x, uint32_t count, float *least, float *largest)
{
	f32x4 low = load4(x), high = low;
	for (uint32_t k = 4; k < count; k += 4) {
		const f32x4 v = load4(x + (k + 4 <= count ? k : count - 4));
		const mask4 below = v < low, above = v > high;
		low = (f32x4)(((mask4)v & below) | ((mask4)low & ~below));
		high = (f32x4)(((mask4)v & above) | ((mask4)high & ~above));
	}
	const float l0 = low[0] < low[1] ? low[0] : low[1], l1 = low[2] < low[3] ? low[2] : low[3];
	const float h0 = high[0] > high[1] ? high[0] : high[1], h1 = high[2] > high[3] ? high[2] : high[3];
	*least = l0 < l1 ? l0 : l1;
	*largest = h0 > h1 ? h0 : h1;
}

/* The three codes of a block's shares, within the range of the shares themselves. */
static void fit_shares(const struct hats *hats, const float *const share[2], const float *mean, float dark, float *const codes[2])
{
	const float STEEP = 0.02f; /* from this range within a block on, dark cells may mislead the plain fit */
	float low[2], high[2];
	for (int c = 0; c < 2; c++)
		range_find(share[c], hats->width + 1, &low[c], &high[c]);
	if (high[0] - low[0] > STEEP || high[1] - low[1] > STEEP) {
		fit_weighted(hats, share, mean, dark, codes);
	} else {
		for (int c = 0; c < 2; c++) {
			f32x4 sum[3] = {{0}};
			for (uint32_t k = 0; k < CELLS_MAX; k += 4)
				for (int a = 0; a < 3; a++)
					sum[a] += load4(share[c] + k) * load4(hats->fit[a] + k);
			for (int a = 0; a < 3; a++)
				codes[c][a] = sum4(sum[a]);
		}
	}
	for (int c = 0; c < 2; c++)
		for (int a = 0; a < 3; a++)
			codes[c][a] = codes[c][a] > low[c] ? (codes[c][a] < high[c] ? codes[c][a] : high[c]) : low[c];
}

static void row_prepare(const struct expansion *e, size_t row, float factor, uint32_t padded, int channels, struct compact_row *out)
{
	const uint32_t width = e->dims.phi_d;
	const float *red = e->rgb[0] + row * width, *green = e->rgb[1] + row * width, *blue = e->rgb[2] + row * width;
	float *restrict root = out->root, *restrict r_share = out->share[0], *restrict b_share = out->share[1], *restrict means = out->mean;
	const float third = factor / 3;
	for (uint32_t k = 0; k < width; k++) {
		float r = red[k] * third, b = blue[k] * third, mean = r + green[k] * third + b;
		bool black = mean < 0x1p-120f;
		float per = 1 / (black ? 1 : mean);
		r_share[k] = black ? 1.0f / 3 : r * per;
		b_share[k] = black ? 1.0f / 3 : b * per;
		means[k] = mean;
		root[k] = sqrtf(sqrtf(mean));
	}
	for (uint32_t k = width; k < padded; k++) {
		out->root[k] = out->root[k - width];
		for (int c = 0; c < 2 && channels == 3; c++)
			out->share[c][k] = out->share[c][k - width];
		if (channels == 3)
			out->mean[k] = out->mean[k - width];
	}
}

static void block_roots(const float *root, uint32_t count, uint8_t *block)
{
	float low, high;
	range_find(root, count, &low, &high);
	/* the base rounded down, the step up: their range holds every value */
	uint16_t base = (uint16_t)(bits_of_float(low) >> COMPACT_HEAD_SHIFT);
	float from = float_of_bits((uint32_t)base << COMPACT_HEAD_SHIFT);
	uint16_t step = (uint16_t)((bits_of_float((high - from) * (1.0f / 255)) + (1u << COMPACT_HEAD_SHIFT) - 1) >> COMPACT_HEAD_SHIFT);
	float width = float_of_bits((uint32_t)step << COMPACT_HEAD_SHIFT), per = width > 0x1p-120f ? 1 / width : 0;
	memcpy(block, &base, sizeof base);
	memcpy(block + 2, &step, sizeof step);
	uint8_t codes[CELLS_MAX];
	for (int k = 0; k < CELLS_MAX; k++) {
		float code = (root[k] - from) * per + 0.5f;
		code = code > 0 ? code : 0; /* past the count, where it means nothing */
		codes[k] = (uint8_t)(int)(code < 255 ? code : 255);
	}
	memcpy(block + COMPACT_RESIDUALS, codes, count);
}

static uint32_t share_code(float share, float base, float per)
{
	float code = (share - base) * per + 0.5f;
	return (uint32_t)(code < 0 ? 0 : code > 4095 ? 4095 : (int32_t)code);
}

/* The first block of row (i, j) of phi_d; the next ones are two blocks apart. */
static uint8_t *row_at(const struct table *t, size_t i, size_t j)
{
	return t->store + i * t->slice + j / 2 * t->row + j % 2 * t->block_bytes;
}

bp_status compact_fill(struct table *t, const struct expansion *e, float largest, bp_error *error)
{
	const uint32_t period = e->dims.phi_d, blocks = (period + COMPACT_WIDTH_MAX - 1) / COMPACT_WIDTH_MAX;
	const size_t rows = (size_t)e->dims.theta_h * e->dims.theta_d;
	t->width = (period + blocks - 1) / blocks;
	t->half = (t->width + 1) / 2;
	t->width_reciprocal = (65536 + t->width - 1) / t->width;
	t->half_reciprocal = 1 / (float)t->half;
	t->block_bytes = t->channels == 3 ? COMPACT_BLOCK_RGB : COMPACT_BLOCK_MONO;
	t->row = 2 * blocks * t->block_bytes;
	t->slice = t->row * ((e->dims.theta_d + 1) / 2);
	const size_t cells_bytes = ((size_t)e->dims.theta_h * t->slice + TABLE_SLACK_BYTES + 7) & ~(size_t)7;
	t->store_bytes = cells_bytes + period * sizeof *t->place + e->dims.theta_d * sizeof *t->rows;

	const uint32_t padded = blocks * t->width + 1, kept = 3 * blocks;
	const float factor = table_factor(largest);
	const size_t line = padded + CELLS_MAX; /* a row, and what a block's last vectors read past it */
	size_t scratch_bytes = (4 * line + 2 * rows * kept) * sizeof(float);
	float *scratch = malloc(scratch_bytes);
	t->store = memory_alloc(t->store_bytes);
	if (!scratch || !t->store) {
		free(scratch);
		return error_memory(error, scratch ? t->store_bytes : scratch_bytes);
	}
	struct compact_row row = {scratch, {scratch + line, scratch + 2 * line}, scratch + 3 * line};
	float *knots[2] = {scratch + 4 * line, scratch + 4 * line + rows * kept};
	memset(scratch, 0, 4 * line * sizeof *scratch);
	float low[2] = {1, 1}, high[2] = {0, 0};
	const float dark = dark_of(largest * e->unit);
	struct hats hats;
	hats_make(t->width, t->half, &hats);

	memset(t->store, 0, t->store_bytes);
	t->place = (struct compact_place *)(void *)(t->store + cells_bytes);
	for (uint32_t k = 0; k < period; k++) {
		uint32_t in = k % t->width, later = in >= t->half;
		t->place[k] = (struct compact_place){
			.block = (uint16_t)(k / t->width * 2 * t->block_bytes),
			.residual = (uint8_t)(COMPACT_RESIDUALS + in),
			.share = (uint8_t)(COMPACT_SHARES + 3 * later),
			.place = (float)(int32_t)(in - later * t->half) * t->half_reciprocal,
		};
	}
	t->rows = (struct compact_rows *)(void *)(t->place + period);
	for (uint32_t j = 0; j < e->dims.theta_d; j++)
		t->rows[j] = (struct compact_rows){
			.offset = t->row * (j / 2) + j % 2 * t->block_bytes,
			.step = j % 2 ? t->row - t->block_bytes : t->block_bytes,
		};
	for (size_t r = 0; r < rows; r++) {
		uint8_t *block = row_at(t, r / e->dims.theta_d, r % e->dims.theta_d);
		row_prepare(e, r, factor, padded, t->channels, &row);
		for (uint32_t b = 0; b < blocks; b++, block += 2 * t->block_bytes) {
			block_roots(row.root + b * t->width, t->width + 1, block);
			if (t->channels != 3)
				continue;
			const float *const share[2] = {row.share[0] + b * t->width, row.share[1] + b * t->width};
			float *const codes[2] = {knots[0] + (r * blocks + b) * 3, knots[1] + (r * blocks + b) * 3};
			fit_shares(&hats, share, row.mean + b * t->width, dark, codes);
			for (int c = 0; c < 2; c++)
				for (int a = 0; a < 3; a++) {
					low[c] = codes[c][a] < low[c] ? codes[c][a] : low[c];
					high[c] = codes[c][a] > high[c] ? codes[c][a] : high[c];
				}
		}
	}
	const float step[2] = {(high[0] - low[0]) / 4095, (high[1] - low[1]) / 4095};
	const float unit = 3 * t->unit;
	t->mix[0] = (f32x4){step[0], -step[0], 0, 0} * unit;
	t->mix[1] = (f32x4){0, -step[1], step[1], 0} * unit;
	t->mix[2] = (f32x4){low[0], 1 - low[0] - low[1], low[1], 0} * unit;
	if (t->channels == 3) {
		float per[2] = {high[0] > low[0] ? 4095 / (high[0] - low[0]) : 0, high[1] > low[1] ? 4095 / (high[1] - low[1]) : 0};
		const float *knot[2] = {knots[0], knots[1]};
		for (size_t r = 0; r < rows; r++) {
			uint8_t *block = row_at(t, r / e->dims.theta_d, r % e->dims.theta_d);
			for (uint32_t b = 0; b < blocks; b++, block += 2 * t->block_bytes)
				for (int a = 0; a < 3; a++) {
					const uint32_t code = share_code(*knot[0]++, low[0], per[0]) | share_code(*knot[1]++, low[1], per[1]) << 12;
					uint8_t *at = block + COMPACT_SHARES + 3 * a;
					at[0] = (uint8_t)code;
					at[1] = (uint8_t)(code >> 8);
					at[2] = (uint8_t)(code >> 16);
				}
		}
	}
	free(scratch);
	return BP_OK;
}
