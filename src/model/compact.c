#include "compact.h"

#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "fast_math.h"

/* A row as the blocks want it: `cells` values, the first repeated at the end as often as the last block is short, and once more. */
struct compact_row {
	float *root;     /* fourth root of G (or of the mean), in [0, 1] */
	float *ratio[2]; /* log2(R/G), log2(B/G); 0 where the cell is 0 */
};

/*
 * Least squares for the three ratio codes of a block: rows of (A^T A)^-1 A^T for hat functions at 0, half, 2 half
 * over cells 0..width, as long as each code has a cell of its own (width >= half + 1; a block of MERL has 18 and 9).
 */
static void fit_matrix(uint32_t width, uint32_t half, float fit[3][COMPACT_WIDTH_MAX + 1])
{
	double hat[3][COMPACT_WIDTH_MAX + 1] = {{0}}, normal[3][6] = {{0}};
	for (uint32_t k = 0; k <= width; k++) {
		uint32_t m = k < half ? 0 : 1;
		double t = (double)(k - m * half) / half;
		hat[m][k] = 1 - t;
		hat[m + 1][k] = t;
	}
	for (int a = 0; a < 3; a++) {
		for (int b = 0; b < 3; b++)
			for (uint32_t k = 0; k <= width; k++)
				normal[a][b] += hat[a][k] * hat[b][k];
		normal[a][3 + a] = 1;
	}
	for (int a = 0; a < 3; a++) { /* Gauss-Jordan; the matrix is positive definite, so no pivoting */
		double pivot = 1 / normal[a][a];
		for (int b = 0; b < 6; b++)
			normal[a][b] *= pivot;
		for (int c = 0; c < 3; c++) {
			double factor = normal[c][a];
			for (int b = 0; c != a && b < 6; b++)
				normal[c][b] -= factor * normal[a][b];
		}
	}
	for (int a = 0; a < 3; a++)
		for (uint32_t k = 0; k <= width; k++) {
			double sum = 0;
			for (int b = 0; b < 3; b++)
				sum += normal[a][3 + b] * hat[b][k];
			fit[a][k] = (float)sum;
		}
}

static void row_prepare(const struct expansion *e, size_t row, float factor, uint32_t padded, int channels, struct compact_row *out)
{
	const uint32_t width = e->dims.phi_d;
	const float *red = e->rgb[0] + row * width, *green = e->rgb[1] + row * width, *blue = e->rgb[2] + row * width;
	if (channels == 1) {
		float third = factor / 3;
		for (uint32_t k = 0; k < width; k++)
			out->root[k] = sqrtf(sqrtf(red[k] * third + green[k] * third + blue[k] * third));
	} else {
		for (uint32_t k = 0; k < width; k++) {
			float r = red[k] * factor, g = green[k] * factor, b = blue[k] * factor;
			float most = r > g ? r : g;
			most = b > most ? b : most;
			most = most > 0x1p-100f ? most : 0;
			float least = most > 0 ? most * 0x1p-12f : 1; /* keeps the logarithms of a zero cell at 0 */
			g = g > least ? g : least;
			r = r > least ? r : least;
			b = b > least ? b : least;
			float l = fast_log2f(g);
			out->ratio[0][k] = fast_log2f(r) - l;
			out->ratio[1][k] = fast_log2f(b) - l;
			out->root[k] = most > 0 ? sqrtf(sqrtf(g)) : 0;
		}
	}
	for (uint32_t k = width; k < padded; k++) {
		out->root[k] = out->root[k - width];
		for (int c = 0; c < 2 && channels == 3; c++)
			out->ratio[c][k] = out->ratio[c][k - width];
	}
}

static void block_roots(const float *root, uint32_t count, uint8_t *block)
{
	float low = root[0], high = root[0];
	for (uint32_t k = 1; k < count; k++) {
		low = root[k] < low ? root[k] : low;
		high = root[k] > high ? root[k] : high;
	}
	uint16_t base = table_encode(low);
	if (base && table_decode(base) > low)
		base--;
	float from = table_decode(base);
	uint16_t step = table_encode((high - from) * (1.0f / 255));
	if (from + 255 * table_decode(step) < high) /* rounded down */
		step = (uint16_t)(step < 1 << 10 ? 1 << 10 : step + 1);
	float width = table_decode(step), per = width > 0 ? 1 / width : 0;
	memcpy(block, &base, sizeof base);
	memcpy(block + 2, &step, sizeof step);
	for (uint32_t k = 0; k < count; k++) {
		float code = (root[k] - from) * per + 0.5f;
		block[COMPACT_RESIDUALS + k] = (uint8_t)(code < 255 ? (int)code : 255);
	}
}

static uint32_t ratio_code(float ratio, float base, float per)
{
	float code = (ratio - base) * per + 0.5f;
	return (uint32_t)(code < 0 ? 0 : code > 4095 ? 4095 : (int32_t)code);
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
	t->row = blocks * t->block_bytes;
	t->store_bytes = rows * t->row + TABLE_SLACK_BYTES;

	const uint32_t padded = blocks * t->width + 1, kept = 3 * blocks;
	const float factor = table_factor(largest);
	size_t scratch_bytes = (3 * (size_t)padded + 2 * rows * kept) * sizeof(float);
	float *scratch = malloc(scratch_bytes);
	t->store = table_store_alloc(t->store_bytes);
	if (!scratch || !t->store) {
		free(scratch);
		return error_memory(error, scratch ? t->store_bytes : scratch_bytes);
	}
	struct compact_row row = {scratch, {scratch + padded, scratch + 2 * padded}};
	float *knots[2] = {scratch + 3 * padded, scratch + 3 * padded + rows * kept};
	float low[2] = {0, 0}, high[2] = {0, 0}, fit[3][COMPACT_WIDTH_MAX + 1];
	fit_matrix(t->width, t->half, fit);

	for (size_t r = 0; r < rows; r++) {
		row_prepare(e, r, factor, padded, t->channels, &row);
		for (uint32_t b = 0; b < blocks; b++) {
			uint8_t *block = t->store + r * t->row + b * t->block_bytes;
			memset(block, 0, t->block_bytes);
			block_roots(row.root + b * t->width, t->width + 1, block);
			for (int c = 0; c < 2 && t->channels == 3; c++)
				for (int a = 0; a < 3; a++) {
					const float *ratio = row.ratio[c] + b * t->width;
					float sum = 0;
					for (uint32_t k = 0; k <= t->width; k++)
						sum += fit[a][k] * ratio[k];
					sum = sum < -13 ? -13 : sum > 13 ? 13 : sum;
					knots[c][(r * blocks + b) * 3 + (size_t)a] = sum;
					low[c] = sum < low[c] ? sum : low[c];
					high[c] = sum > high[c] ? sum : high[c];
				}
		}
	}
	memset(t->store + rows * t->row, 0, TABLE_SLACK_BYTES);
	for (int c = 0; c < 2; c++) {
		t->ratio_base[c] = low[c];
		t->ratio_step[c] = (high[c] - low[c]) / 4095;
	}
	if (t->channels == 3) {
		float per[2] = {high[0] > low[0] ? 4095 / (high[0] - low[0]) : 0, high[1] > low[1] ? 4095 / (high[1] - low[1]) : 0};
		for (size_t n = 0; n < rows * kept; n++) {
			uint32_t code = ratio_code(knots[0][n], low[0], per[0]) | ratio_code(knots[1][n], low[1], per[1]) << 12;
			uint8_t *at = t->store + n / 3 * COMPACT_BLOCK_RGB + COMPACT_RATIOS + 3 * (n % 3);
			at[0] = (uint8_t)code;
			at[1] = (uint8_t)(code >> 8);
			at[2] = (uint8_t)(code >> 16);
		}
	}
	free(scratch);
	return BP_OK;
}
