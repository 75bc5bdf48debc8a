/* Rows of the compact form: near the values they are made from, and alike on every processor. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "model/table/compact.h"
#include "model/math/fast_math.h"
#include "model/math/kernels.h"

enum { PERIOD_MAX = 180, BLOCKS_MAX = 10, LINE = PERIOD_MAX + 2 * CELLS_MAX };

static uint64_t state = 11;
static float uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (float)((double)(state >> 11) * 0x1p-53);
}

/* What one row gives. */
struct outcome {
	uint8_t blocks[BLOCKS_MAX * 2 * COMPACT_BLOCK_RGB];
	float knots[2][3 * BLOCKS_MAX], scratch[4][LINE];
};

static void row_make(compact_row_fn *make, uint32_t period, int channels, const float *const rgb[3], struct outcome *out)
{
	const uint32_t blocks = (period + COMPACT_WIDTH_MAX - 1) / COMPACT_WIDTH_MAX, width = (period + blocks - 1) / blocks;
	struct compact_rows_plan plan = {
		.period = period,
		.padded = blocks * width + 1,
		.blocks = blocks,
		.width = width,
		.block_bytes = channels == 3 ? COMPACT_BLOCK_RGB : COMPACT_BLOCK_MONO,
		.channels = channels,
		.third = 1.0f / 3,
		.dark = 1e-4f,
	};
	memset(out, 0, sizeof *out);
	plan.row = (struct compact_row){out->scratch[0], {out->scratch[1], out->scratch[2]}, out->scratch[3]};
	compact_hats_make(width, (width + 1) / 2, &plan.hats);
	make(&plan, rgb, out->blocks, (float *const[]){out->knots[0], out->knots[1]});
	for (uint32_t n = 0; n < 3 * blocks * (channels == 3); n++) /* a knot lies among the shares of its block */
		for (int c = 0; c < 2; c++) {
			const float *share = out->scratch[1 + c] + n / 3 * width;
			float low = 1, high = 0;
			for (uint32_t k = 0; k <= width; k++) {
				low = fminf(low, share[k]);
				high = fmaxf(high, share[k]);
			}
			assert_true(out->knots[c][n] >= low && out->knots[c][n] <= high);
		}
	for (uint32_t k = 0; k < period; k++) {
		const uint8_t *block = out->blocks + k / width * 2 * plan.block_bytes;
		uint16_t head[2];
		memcpy(head, block, sizeof head);
		const float base = float_of_bits((uint32_t)head[0] << COMPACT_HEAD_SHIFT),
					step = float_of_bits((uint32_t)head[1] << COMPACT_HEAD_SHIFT);
		const float root = base + step * (float)block[COMPACT_RESIDUALS + k % width];
		assert_true(fabsf(root - sqrtf(sqrtf((rgb[0][k] + rgb[1][k] + rgb[2][k]) / 3))) <= 0.501f * step + 1e-6f);
	}
}

static void residuals_are_within_half_a_step_and_alike_on_every_processor(void **unused)
{
	static const uint32_t PERIODS[] = {PERIOD_MAX, 37, 18, 5};
	static struct outcome outcome[2];
	float values[3][PERIOD_MAX];
	const float *const rgb[3] = {values[0], values[1], values[2]};
	(void)unused;

	for (int trial = 0; trial < 200; trial++) {
		const int kind = trial % 4; /* smooth, noisy, with black cells, all black */
		for (int k = 0; k < PERIOD_MAX; k++)
			for (int c = 0; c < 3; c++) {
				const float smooth = 0.3f + 0.2f * sinf((float)k * 0.05f + (float)(c + trial));
				values[c][k] = kind == 3 || (kind == 2 && k % 5 == 0) ? 0 : kind == 0 ? smooth : smooth * powf(uniform(), 8);
			}
		for (size_t p = 0; p < sizeof PERIODS / sizeof *PERIODS; p++)
			for (int channels = 1; channels <= 3; channels += 2) {
				row_make(compact_row_plain, PERIODS[p], channels, rgb, &outcome[0]);
				row_make(kernels_avx2_usable() ? compact_row_avx2 : compact_row_plain, PERIODS[p], channels, rgb, &outcome[1]);
				assert_memory_equal(&outcome[0], &outcome[1], sizeof outcome[0]);
			}
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(residuals_are_within_half_a_step_and_alike_on_every_processor),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
