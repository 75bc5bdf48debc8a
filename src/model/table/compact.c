#include "compact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "model/math/kernels.h"

void compact_hats_make(uint32_t width, uint32_t half, struct compact_hats *out)
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
		compact_solve(system, x);
		for (int a = 0; a < 3; a++)
			out->fit[a][k] = x[a];
	}
}

/* Shares of cells well below this count little: 1e-3/sr, as a share of the table's largest value, within reason. */
static float dark_of(double largest)
{
	double dark = 1e-3 / largest;
	return (float)(dark < 0x1p-11 ? fmax(dark, 0x1p-31) : 0x1p-11);
}

/* `per` is infinite where the range of shares is next to nothing; then the lowest, no number, is 0. */
static uint32_t share_code(float share, float base, float per)
{
	const float code = (share - base) * per + 0.5f;
	return (uint32_t)(int32_t)(code > 0 ? code < 4095 ? code : 4095 : 0);
}

/* The first block of row (i, j) of phi_d; the next ones are two blocks apart. */
static uint8_t *row_at(const struct table *t, size_t i, size_t j)
{
	return t->store + i * t->slice + j / 2 * t->row + j % 2 * t->block_bytes;
}

/* The shares' codes in 12 bits each, once their range over the whole table is known: low and high of R's and of B's. */
static void shares_fill(struct table *t, uint32_t blocks, const float *const knots[2], const float low[2], const float high[2])
{
	const size_t rows = (size_t)t->dims.theta_h * t->dims.theta_d;
	const float per[2] = {4095 / (high[0] - low[0]), 4095 / (high[1] - low[1])};
	const float *knot[2] = {knots[0], knots[1]};

	for (size_t r = 0; r < rows; r++) {
		uint8_t *block = row_at(t, r / t->dims.theta_d, r % t->dims.theta_d);
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
	const size_t cells_bytes = (size_t)e->dims.theta_h * t->slice;

	const uint32_t padded = blocks * t->width + 1, kept = 3 * blocks;
	const size_t line = padded + CELLS_MAX; /* a row, and what a block's last vectors read past it */
	size_t scratch_bytes = (4 * line + 2 * rows * kept) * sizeof(float);
	float *scratch = malloc(scratch_bytes);
	if (!scratch)
		return error_memory(error, scratch_bytes);
	bp_status status = table_store_alloc(t, cells_bytes, error);
	if (status) {
		free(scratch);
		return status;
	}
	float *const knots[2] = {scratch + 4 * line, scratch + 4 * line + rows * kept};
	memset(scratch, 0, 4 * line * sizeof *scratch);
	memset(t->store, 0, cells_bytes);

	struct compact_rows_plan plan = {
		.period = period,
		.padded = padded,
		.blocks = blocks,
		.width = t->width,
		.block_bytes = t->block_bytes,
		.channels = t->channels,
		.third = table_factor(largest) / 3,
		.dark = dark_of(largest * e->unit),
		.row = {scratch, {scratch + line, scratch + 2 * line}, scratch + 3 * line},
	};
	compact_row_fn *const row_make = kernels_avx2_usable() ? compact_row_avx2 : compact_row_plain;
	float low[2] = {1, 1}, high[2] = {0, 0};
	compact_hats_make(t->width, t->half, &plan.hats);
	for (size_t r = 0; r < rows; r++) {
		const float *const rgb[3] = {e->rgb[0] + r * period, e->rgb[1] + r * period, e->rgb[2] + r * period};
		float *const codes[2] = {knots[0] + r * kept, knots[1] + r * kept};
		row_make(&plan, rgb, row_at(t, r / e->dims.theta_d, r % e->dims.theta_d), codes);
		for (int c = 0; c < 2 && t->channels == 3; c++)
			for (uint32_t n = 0; n < kept; n++) {
				low[c] = codes[c][n] < low[c] ? codes[c][n] : low[c];
				high[c] = codes[c][n] > high[c] ? codes[c][n] : high[c];
			}
	}
	const float step[2] = {(high[0] - low[0]) / 4095, (high[1] - low[1]) / 4095};
	const float unit = 3 * t->unit;
	t->mix[0] = (f32x4){step[0], -step[0], 0, 0} * unit;
	t->mix[1] = (f32x4){0, -step[1], step[1], 0} * unit;
	t->mix[2] = (f32x4){low[0], 1 - low[0] - low[1], low[1], 0} * unit;
	if (t->channels == 3)
		shares_fill(t, blocks, (const float *const[]){knots[0], knots[1]}, low, high);
	free(scratch);
	return BP_OK;
}
