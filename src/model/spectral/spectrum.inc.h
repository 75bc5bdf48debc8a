/* spectrum.inc.h: products with cosine tables, and lifting steps. See spectral_kernels.h and spectrum.h. */
#include <string.h>

#include "spectrum.h"

/*
 * `rows` rows times `width` columns, both constants where this is inlined, and their product at most eight vectors: the sums stay
 * in registers. The sum over k runs in ascending order.
 */
static ALWAYS_INLINE void KERNEL(product_part)(const float *x, size_t in_stride, size_t rows, size_t count, const float *matrix,
                                               size_t columns, size_t width, float *y, size_t out_stride)
{
	const size_t vectors = width / FLOATS_WIDE;
	floats_wide sum[8] = {{0}};

	for (size_t k = 0; k < count; k++, matrix += columns)
		for (size_t v = 0; v < vectors; v++)
			for (size_t q = 0; q < rows; q++)
				sum[q * vectors + v] += x[q * in_stride + k] * FLOATS_WIDE_LOAD(matrix + FLOATS_WIDE * v);
	for (size_t q = 0; q < rows; q++)
		for (size_t v = 0; v < vectors; v++)
			FLOATS_WIDE_STORE(y + q * out_stride + FLOATS_WIDE * v, sum[q * vectors + v]);
}

/* Four or eight rows times 16 columns at once; of a row that is left, 48 columns, then 16. */
static void KERNEL(cosine_product)(const float *in, size_t in_stride, size_t rows, size_t count, const float *matrix,
                                   size_t columns, float *out, size_t out_stride)
{
	enum { ROWS = FLOATS_WIDE / 2 };

	for (; rows >= ROWS; rows -= ROWS, in += ROWS * in_stride, out += ROWS * out_stride)
		for (size_t c = 0; c < columns; c += 16)
			KERNEL(product_part)(in, in_stride, ROWS, count, matrix + c, columns, 16, out + c, out_stride);
	for (; rows >= 4; rows -= 4, in += 4 * in_stride, out += 4 * out_stride)
		for (size_t c = 0; c < columns; c += 16)
			KERNEL(product_part)(in, in_stride, 4, count, matrix + c, columns, 16, out + c, out_stride);
	for (; rows; rows--, in += in_stride, out += out_stride) {
		size_t c = 0;
		for (; c + 48 <= columns; c += 48)
			KERNEL(product_part)(in, in_stride, 1, count, matrix + c, columns, 48, out + c, out_stride);
		for (; c < columns; c += 16)
			KERNEL(product_part)(in, in_stride, 1, count, matrix + c, columns, 16, out + c, out_stride);
	}
}

static void KERNEL(span_unfold)(const float *sum, const float *difference, size_t n, float *out)
{
	const size_t half = n / 2;
	size_t k = 0;

	for (; k + 8 <= half; k += 8) {
		const floats8 s = FLOATS8_LOAD(sum + k), d = FLOATS8_LOAD(difference + k), back = s - d;
		FLOATS8_STORE(out + k, s + d);
		FLOATS8_STORE(out + n - 8 - k, __builtin_shufflevector(back, back, 7, 6, 5, 4, 3, 2, 1, 0));
	}
	for (; k < half; k++) {
		out[k] = sum[k] + difference[k];
		out[n - 1 - k] = sum[k] - difference[k];
	}
	if (n % 2)
		out[half] = sum[half];
}

#define CDF97_A (-1.586134342059924f)
#define CDF97_B (-0.052980118572961f)
#define CDF97_C 0.882911075530934f
#define CDF97_D 0.443506852043971f

/*
 * One step along a line of n >= 2 vectors, `stride` floats apart: the four lifting steps in one pass, each a place behind the one
 * before; x[-1] is x[1], x[n] is x[n - 2]. Low coefficients go where their line has been read, high ones to scratch and then
 * behind them.
 */
static ALWAYS_INLINE void KERNEL(cdf97_forward_line)(float *x, size_t n, size_t stride, float *scratch)
{
	const size_t low = (n + 1) / 2, high = n / 2;
	floats_wide even = FLOATS_WIDE_LOAD(x), odd_a = {0}, even_b = {0},
				odd_c = {0}; /* the last place after no step, the first, the second, the third */

	for (size_t i = 0; i < low; i++) {
		const float *here = x + 2 * i * stride;
		const floats_wide next = i + 1 < low ? FLOATS_WIDE_LOAD(here + 2 * stride) : even;
		floats_wide odd = odd_a;
		__builtin_prefetch(here + 2 * FLOATS_WIDE, 1);
		if (2 * i + 1 < n) {
			__builtin_prefetch(here + stride + 2 * FLOATS_WIDE, 1);
			odd = FLOATS_WIDE_LOAD(here + stride) + CDF97_A * (even + next);
		}
		const floats_wide b = even + CDF97_B * ((i ? odd_a : odd) + odd);
		if (i) {
			const floats_wide c = odd_a + CDF97_C * (even_b + b);
			const floats_wide d = even_b + CDF97_D * ((i > 1 ? odd_c : c) + c);
			FLOATS_WIDE_STORE(x + (i - 1) * stride, d * SPECTRUM_GAIN);
			FLOATS_WIDE_STORE(scratch + FLOATS_WIDE * (i - 1), c * (1 / SPECTRUM_GAIN));
			odd_c = c;
		}
		odd_a = odd;
		even_b = b;
		even = next;
	}
	if (high == low) {
		const floats_wide c = odd_a + CDF97_C * (even_b + even_b);
		FLOATS_WIDE_STORE(scratch + FLOATS_WIDE * (high - 1), c * (1 / SPECTRUM_GAIN));
		FLOATS_WIDE_STORE(x + (low - 1) * stride, (even_b + CDF97_D * ((low > 1 ? odd_c : c) + c)) * SPECTRUM_GAIN);
	} else {
		FLOATS_WIDE_STORE(x + (low - 1) * stride, (even_b + CDF97_D * (odd_c + odd_c)) * SPECTRUM_GAIN);
	}
	for (size_t i = 0; i < high; i++)
		FLOATS_WIDE_STORE(x + (low + i) * stride, FLOATS_WIDE_LOAD(scratch + FLOATS_WIDE * i));
}

static void KERNEL(cdf97_forward)(float *x, size_t n, size_t stride, size_t width, float *scratch)
{
	const size_t whole = width / FLOATS_WIDE * FLOATS_WIDE, rest = width - whole;

	for (size_t q = 0; q < whole; q += FLOATS_WIDE)
		KERNEL(cdf97_forward_line)(x + q, n, stride, scratch);
	if (!rest)
		return;
	/* What is left of a vector is worked on elsewhere. */
	float *line = scratch + FLOATS_WIDE / 2 * n;
	memset(line, 0, FLOATS_WIDE * n * sizeof *line);
	for (size_t i = 0; i < n; i++)
		memcpy(line + FLOATS_WIDE * i, x + i * stride + whole, rest * sizeof *line);
	KERNEL(cdf97_forward_line)(line, n, FLOATS_WIDE, scratch);
	for (size_t i = 0; i < n; i++)
		memcpy(x + i * stride + whole, line + FLOATS_WIDE * i, rest * sizeof *line);
}
