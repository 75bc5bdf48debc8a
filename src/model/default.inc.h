/* default.inc.h: the loops of the default profile's fit and expansion. See kernels.h and default_model.h. */
#include "fast_math.h"

static void KERNEL(default_logs)(const double *b, const uint8_t *valid, size_t n, double factor, float *out)
{
	for (size_t k = 0; k < n; k++) {
		float l = fast_log2f(1 + (float)(b[k] * factor));
		out[k] = valid[k] ? l : 0;
	}
}

/* n cells of one channel */
static inline __attribute__((always_inline)) void KERNEL(channel_values)(const float *const field[3], size_t at, size_t n, float base,
                                                                         const float rotation[3], float offset, float *restrict out)
{
	const float *a = field[0] + at, *b = field[1] + at, *d = field[2] + at;

	for (size_t k = 0; k < n; k++) {
		float l = base + (rotation[0] * a[k] + rotation[1] * b[k] + rotation[2] * d[k]);
		l = l > 40 ? 40 : l;
		l = l > 0 ? l : 0; /* NaN becomes 0 as well */
		out[k] = offset * (fast_exp2f_within(l) - 1);
	}
}

static void KERNEL(default_values)(const float *const field[3], size_t rows, size_t width, size_t stride, const float base[3],
                                   const float rotation[3][3], float offset, float *const rgb[3], size_t rgb_stride)
{
	enum { BLOCK = 16 };

	for (size_t i = 0; i < rows; i++)
		for (int c = 0; c < 3; c++) {
			const float weight[3] = {rotation[0][c], rotation[1][c], rotation[2][c]};
			float *out = rgb[c] + i * rgb_stride;
			/* Rows of a block lie apart, which no processor foresees: without this the stores take twice the time of all the rest. */
			if (i + 16 < rows) {
				__builtin_prefetch(out + 16 * rgb_stride, 1);
				__builtin_prefetch(out + 16 * rgb_stride + BLOCK - 1, 1);
				__builtin_prefetch(field[c] + (i + 16) * stride);
			}
			if (width >= BLOCK && stride == BLOCK)
				KERNEL(channel_values)(field, i * stride, BLOCK, base[c], weight, offset, out);
			else
				KERNEL(channel_values)(field, i * stride, width, base[c], weight, offset, out);
		}
}

static void KERNEL(default_rotate)(float *const x[3], size_t n, const float m[3][3])
{
	float *restrict a = x[0], *restrict b = x[1], *restrict c = x[2];

	for (size_t k = 0; k < n; k++) {
		const float r = a[k], s = b[k], t = c[k];
		a[k] = m[0][0] * r + m[0][1] * s + m[0][2] * t;
		b[k] = m[1][0] * r + m[1][1] * s + m[1][2] * t;
		c[k] = m[2][0] * r + m[2][1] * s + m[2][2] * t;
	}
}

/* phi_d counts four times: along it the field is smoothest, and its basis has the fewest coefficients. Mirrored at its ends. */
static void KERNEL(default_smooth)(float *row, const uint8_t *valid, const float *const neighbour[4], size_t n, float *scratch)
{
	const float *a = neighbour[0], *b = neighbour[1], *c = neighbour[2], *d = neighbour[3];
	float *copy = scratch + 1;

	for (size_t k = 0; k < n; k++)
		copy[k] = row[k];
	copy[-1] = copy[0];
	copy[n] = copy[n - 1];
	for (size_t k = 0; k < n; k++) {
		float mean = (4 * (copy[(ptrdiff_t)k - 1] + copy[k + 1]) + ((a[k] + b[k]) + (c[k] + d[k]))) * (1.0f / 12);
		row[k] = valid[k] ? copy[k] : mean;
	}
}

static void KERNEL(default_shrink)(const float *const rows[9], const float *threshold, size_t n, float *out)
{
	const float *here = rows[4];
	float energy[n], count = 0;

	for (size_t q = 0; q < n; q++)
		energy[q] = 0;
	for (int r = 0; r < 9; r++)
		if (rows[r]) {
			const float *x = rows[r];
			for (size_t q = 0; q < n; q++)
				energy[q] += x[q] * x[q];
			count++;
		}
	for (size_t q = 0; q + 1 < n; q++) {
		energy[q] += 0.5f * here[q + 1] * here[q + 1];
		energy[q + 1] += 0.5f * here[q] * here[q];
	}
	count++;
	for (size_t q = 0; q < n; q++) {
		float keep = 1 - threshold[q] * count / (energy[q] + 1e-30f);
		out[q] = here[q] * (keep > 0 ? keep : 0);
	}
}
