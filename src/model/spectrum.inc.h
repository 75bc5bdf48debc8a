/* spectrum.inc.h: products with cosine tables, and lifting steps. See kernels.h and spectrum.h. */
#include "spectrum.h"

typedef float KERNEL(floats8) __attribute__((vector_size(32)));
typedef float KERNEL(floats8_unaligned) __attribute__((vector_size(32), aligned(4), may_alias));
#define FLOATS8_AT(p) (*(KERNEL(floats8_unaligned) *)(p))
#define FLOATS8_OF(p) ((KERNEL(floats8))(*(const KERNEL(floats8_unaligned) *)(p)))

/*
 * Rows r..r+3, columns c..c+15; the sum over k runs in ascending order. The 4 x 2 accumulators stay in registers.
 */
static void KERNEL(cosine_product)(const float *in, size_t in_stride, size_t rows, size_t count, const float *matrix,
                                   size_t columns, float *out, size_t out_stride)
{
	for (size_t r = 0; r < rows; r += 4) {
		/* The last rows are done again rather than not at all: the same values to the same places. */
		const float *x0 = in + r * in_stride;
		const float *x1 = in + (r + 1 < rows ? r + 1 : r) * in_stride;
		const float *x2 = in + (r + 2 < rows ? r + 2 : r) * in_stride;
		const float *x3 = in + (r + 3 < rows ? r + 3 : r) * in_stride;
		float *y0 = out + r * out_stride;
		float *y1 = out + (r + 1 < rows ? r + 1 : r) * out_stride;
		float *y2 = out + (r + 2 < rows ? r + 2 : r) * out_stride;
		float *y3 = out + (r + 3 < rows ? r + 3 : r) * out_stride;

		for (size_t c = 0; c < columns; c += 16) {
			KERNEL(floats8) a0 = {0}, b0 = {0}, a1 = {0}, b1 = {0}, a2 = {0}, b2 = {0}, a3 = {0}, b3 = {0};
			const float *t = matrix + c;
			for (size_t k = 0; k < count; k++, t += columns) {
				const KERNEL(floats8) p = FLOATS8_OF(t), q = FLOATS8_OF(t + 8);
				a0 += x0[k] * p;
				b0 += x0[k] * q;
				a1 += x1[k] * p;
				b1 += x1[k] * q;
				a2 += x2[k] * p;
				b2 += x2[k] * q;
				a3 += x3[k] * p;
				b3 += x3[k] * q;
			}
			FLOATS8_AT(y3 + c) = a3;
			FLOATS8_AT(y3 + c + 8) = b3;
			FLOATS8_AT(y2 + c) = a2;
			FLOATS8_AT(y2 + c + 8) = b2;
			FLOATS8_AT(y1 + c) = a1;
			FLOATS8_AT(y1 + c + 8) = b1;
			FLOATS8_AT(y0 + c) = a0;
			FLOATS8_AT(y0 + c + 8) = b0;
		}
	}
}

/* x[i] += factor (x[i - 1] + x[i + 1]) for i = first, first + 2, ...; the ends are mirrored. Each x[i] is a row of `width`. */
static inline void KERNEL(lift)(float *x, size_t n, size_t stride, size_t width, size_t first, float factor)
{
	for (size_t i = first; i < n; i += 2) {
		const float *before = x + (i ? i - 1 : 1) * stride, *after = x + (i + 1 < n ? i + 1 : i - 1) * stride;
		float *here = x + i * stride;
		for (size_t q = 0; q < width; q++)
			here[q] += factor * (before[q] + after[q]);
	}
}

#define CDF97_A (-1.586134342059924f)
#define CDF97_B (-0.052980118572961f)
#define CDF97_C 0.882911075530934f
#define CDF97_D 0.443506852043971f

static void KERNEL(cdf97_forward)(float *x, size_t n, size_t stride, size_t width, float *scratch)
{
	const size_t low = (n + 1) / 2;

	KERNEL(lift)(x, n, stride, width, 1, CDF97_A);
	KERNEL(lift)(x, n, stride, width, 0, CDF97_B);
	KERNEL(lift)(x, n, stride, width, 1, CDF97_C);
	KERNEL(lift)(x, n, stride, width, 0, CDF97_D);
	for (size_t i = 0; i < n; i++) {
		const float *from = x + i * stride, scale = i % 2 ? 1 / SPECTRUM_GAIN : SPECTRUM_GAIN;
		float *to = scratch + (i % 2 ? low + i / 2 : i / 2) * width;
		for (size_t q = 0; q < width; q++)
			to[q] = from[q] * scale;
	}
	for (size_t i = 0; i < n; i++)
		for (size_t q = 0; q < width; q++)
			x[i * stride + q] = scratch[i * width + q];
}
