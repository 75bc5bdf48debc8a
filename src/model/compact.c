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
	float *weight;   /* what the shares' errors count, in (0, 1]: little in dark cells */
};

enum { CELLS_MAX = COMPACT_WIDTH_MAX + 1 };

/* Shares of cells well below this count little: 1e-3/sr, as a share of the table's largest value, within reason. */
static float dark_of(double largest)
{
	double dark = 1e-3 / largest;
	return (float)(dark < 0x1p-11 ? fmax(dark, 0x1p-31) : 0x1p-11);
}

/* Hat functions at cells 0, half and 2 half. */
struct hats {
	uint32_t width, half;
	float value[3][CELLS_MAX];
	float fit[3][CELLS_MAX]; /* (A^T A)^-1 A^T: the codes for weights that are all alike */
};

/* Solves the symmetric positive definite 3 x 3 system for `columns` right-hand sides, which follow in the rows. */
static void solve(float (*m)[3 + CELLS_MAX], uint32_t columns)
{
	for (int a = 0; a < 3; a++) { /* Gauss-Jordan; no pivoting is needed */
		float pivot = 1 / m[a][a];
		for (uint32_t b = 0; b < 3 + columns; b++)
			m[a][b] *= pivot;
		for (int c = 0; c < 3; c++) {
			float factor = m[c][a];
			for (uint32_t b = 0; c != a && b < 3 + columns; b++)
				m[c][b] -= factor * m[a][b];
		}
	}
}

/*
 * Least squares over cells 0..width: every hat function has a cell of its own as long as width > half
 * (a block of MERL has 18 and 9).
 */
static void hats_make(uint32_t width, uint32_t half, struct hats *out)
{
	float system[3][3 + CELLS_MAX] = {{0}};
	memset(out, 0, sizeof *out);
	out->width = width;
	out->half = half;
	for (uint32_t k = 0; k <= width; k++) {
		uint32_t m = k < half ? 0 : 1;
		float t = (float)(k - m * half) / (float)half;
		out->value[m][k] = 1 - t;
		out->value[m + 1][k] = t;
	}
	for (int a = 0; a < 3; a++) {
		for (int b = 0; b < 3; b++)
			for (uint32_t k = 0; k <= width; k++)
				system[a][b] += out->value[a][k] * out->value[b][k];
		for (uint32_t k = 0; k <= width; k++)
			system[a][3 + k] = out->value[a][k];
	}
	solve(system, width + 1);
	for (int a = 0; a < 3; a++)
		for (uint32_t k = 0; k <= width; k++)
			out->fit[a][k] = system[a][3 + k];
}

static void fit_weighted(const struct hats *hats, const float *share, const float *weight, float codes[3])
{
	float system[3][3 + CELLS_MAX] = {{0}};
	for (int a = 0; a < 3; a++) {
		for (uint32_t k = 0; k <= hats->width; k++) {
			float w = hats->value[a][k] * weight[k];
			for (int b = 0; b < 3; b++)
				system[a][b] += w * hats->value[b][k];
			system[a][3] += w * share[k];
		}
		system[a][a] *= 1.0001f; /* where only dark cells lie under a hat */
	}
	solve(system, 1);
	for (int a = 0; a < 3; a++)
		codes[a] = system[a][3];
}

/* The three codes of a block's shares, within the range of the shares themselves. */
static void fit_shares(const struct hats *hats, const float *share, const float *weight, float codes[3])
{
	const float STEEP = 0.02f; /* from this range within a block on, dark cells may mislead the plain fit */
	float low = share[0], high = share[0];
	for (uint32_t k = 1; k <= hats->width; k++) {
		low = share[k] < low ? share[k] : low;
		high = share[k] > high ? share[k] : high;
	}
	if (high - low > STEEP) {
		fit_weighted(hats, share, weight, codes);
	} else {
		for (int a = 0; a < 3; a++) {
			codes[a] = 0;
			for (uint32_t k = 0; k <= hats->width; k++)
				codes[a] += hats->fit[a][k] * share[k];
		}
	}
	for (int a = 0; a < 3; a++)
		codes[a] = codes[a] > low ? (codes[a] < high ? codes[a] : high) : low;
}

static void row_prepare(const struct expansion *e, size_t row, float factor, float dark, uint32_t padded, int channels,
                        struct compact_row *out)
{
	const uint32_t width = e->dims.phi_d;
	const float *red = e->rgb[0] + row * width, *green = e->rgb[1] + row * width, *blue = e->rgb[2] + row * width;
	float *restrict root = out->root, *restrict r_share = out->share[0], *restrict b_share = out->share[1], *restrict weight = out->weight;
	const float third = factor / 3;
	for (uint32_t k = 0; k < width; k++) {
		float r = red[k] * third, b = blue[k] * third, mean = r + green[k] * third + b;
		bool black = mean < 0x1p-120f;
		float per = 1 / (black ? 1 : mean), bright = mean / (mean + dark);
		r_share[k] = black ? 1.0f / 3 : r * per;
		b_share[k] = black ? 1.0f / 3 : b * per;
		weight[k] = bright * bright + 1e-6f;
		root[k] = sqrtf(sqrtf(mean));
	}
	for (uint32_t k = width; k < padded; k++) {
		out->root[k] = out->root[k - width];
		for (int c = 0; c < 2 && channels == 3; c++)
			out->share[c][k] = out->share[c][k - width];
		if (channels == 3)
			out->weight[k] = out->weight[k - width];
	}
}

static void block_roots(const float *root, uint32_t count, uint8_t *block)
{
	float low = root[0], high = root[0];
	for (uint32_t k = 1; k < count; k++) {
		low = root[k] < low ? root[k] : low;
		high = root[k] > high ? root[k] : high;
	}
	/* the base rounded down, the step up: their range holds every value */
	uint16_t base = (uint16_t)(bits_of_float(low) >> COMPACT_HEAD_SHIFT);
	float from = float_of_bits((uint32_t)base << COMPACT_HEAD_SHIFT);
	uint16_t step = (uint16_t)((bits_of_float((high - from) * (1.0f / 255)) + (1u << COMPACT_HEAD_SHIFT) - 1) >> COMPACT_HEAD_SHIFT);
	float width = float_of_bits((uint32_t)step << COMPACT_HEAD_SHIFT), per = width > 0x1p-120f ? 1 / width : 0;
	memcpy(block, &base, sizeof base);
	memcpy(block + 2, &step, sizeof step);
	for (uint32_t k = 0; k < count; k++) {
		float code = (root[k] - from) * per + 0.5f;
		block[COMPACT_RESIDUALS + k] = (uint8_t)(code < 255 ? (int)code : 255);
	}
}

static uint32_t share_code(float share, float base, float per)
{
	float code = (share - base) * per + 0.5f;
	return (uint32_t)(code < 0 ? 0 : code > 4095 ? 4095 : (int32_t)code);
}

/* Block b of the r-th row of phi_d. */
static uint8_t *block_at(const struct table *t, size_t r, size_t b)
{
	size_t i = r / t->dims.theta_d, j = r % t->dims.theta_d;
	return t->store + i * t->slice + j / 2 * t->row + (2 * b + j % 2) * t->block_bytes;
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
	t->store_bytes = cells_bytes + period * sizeof *t->place;

	const uint32_t padded = blocks * t->width + 1, kept = 3 * blocks;
	const float factor = table_factor(largest);
	size_t scratch_bytes = (4 * (size_t)padded + 2 * rows * kept) * sizeof(float);
	float *scratch = malloc(scratch_bytes);
	t->store = memory_alloc(t->store_bytes);
	if (!scratch || !t->store) {
		free(scratch);
		return error_memory(error, scratch ? t->store_bytes : scratch_bytes);
	}
	struct compact_row row = {scratch, {scratch + padded, scratch + 2 * padded}, scratch + 3 * padded};
	float *knots[2] = {scratch + 4 * padded, scratch + 4 * padded + rows * kept};
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
	for (size_t r = 0; r < rows; r++) {
		row_prepare(e, r, factor, dark, padded, t->channels, &row);
		for (uint32_t b = 0; b < blocks; b++) {
			uint8_t *block = block_at(t, r, b);
			block_roots(row.root + b * t->width, t->width + 1, block);
			for (int c = 0; c < 2 && t->channels == 3; c++) {
				float *codes = knots[c] + (r * blocks + b) * 3;
				fit_shares(&hats, row.share[c] + b * t->width, row.weight + b * t->width, codes);
				for (int a = 0; a < 3; a++) {
					low[c] = codes[a] < low[c] ? codes[a] : low[c];
					high[c] = codes[a] > high[c] ? codes[a] : high[c];
				}
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
		for (size_t n = 0; n < rows * kept; n++) {
			uint32_t code = share_code(knots[0][n], low[0], per[0]) | share_code(knots[1][n], low[1], per[1]) << 12;
			uint8_t *at = block_at(t, n / kept, n % kept / 3) + COMPACT_SHARES + 3 * (n % 3);
			at[0] = (uint8_t)code;
			at[1] = (uint8_t)(code >> 8);
			at[2] = (uint8_t)(code >> 16);
		}
	}
	free(scratch);
	return BP_OK;
}
