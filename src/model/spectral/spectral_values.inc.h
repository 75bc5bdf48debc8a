/* spectral_values.inc.h: the loops of the spectral profile's fit and expansion. See spectral_kernels.h and spectral.h. */
#include "model/math/fast_math.h"

/* Eight double lanes of n floats, joined in one order. */
static double KERNEL(float_sum)(const float *x, size_t n)
{
	lanes4 a = {0}, b = {0};
	double rest = 0;
	size_t k = 0;

	for (; k + 8 <= n; k += 8) {
		a += __builtin_convertvector(FLOATS_LOAD(x + k), lanes4);
		b += __builtin_convertvector(FLOATS_LOAD(x + k + 4), lanes4);
	}
	for (; k < n; k++)
		rest += (double)x[k];
	a += b;
	return lanes_sum(&a) + rest;
}

static double KERNEL(spectral_logs)(const double *b, const uint8_t *valid, size_t n, double factor, float *out)
{
	for (size_t k = 0; k < n; k++) {
		float l = fast_log2f((float)(1 + b[k] * factor)); /* rounded once */
		out[k] = valid[k] ? l : 0;
	}
	return KERNEL(float_sum)(out, n);
}

static void KERNEL(spectral_moments)(const float *const x[3], size_t n, double sums[6])
{
	lanes4 a = {0}, b = {0}, c = {0}, d = {0}, e = {0}, f = {0};
	const lanes4 one = LANES_ALL(1.0);

	for (size_t k = 0; k + 4 <= n; k += 4) {
		const lanes4 r = __builtin_convertvector(FLOATS_LOAD(x[0] + k), lanes4),
					 s = __builtin_convertvector(FLOATS_LOAD(x[1] + k), lanes4),
					 t = __builtin_convertvector(FLOATS_LOAD(x[2] + k), lanes4);
		const lanes4 w = one / (one + (r * r + s * s + t * t)), wr = w * r, ws = w * s;
		a += wr * r;
		b += wr * s;
		c += wr * t;
		d += ws * s;
		e += ws * t;
		f += w * t * t;
	}
	sums[0] += lanes_sum(&a);
	sums[1] += lanes_sum(&b);
	sums[2] += lanes_sum(&c);
	sums[3] += lanes_sum(&d);
	sums[4] += lanes_sum(&e);
	sums[5] += lanes_sum(&f);
	for (size_t k = n / 4 * 4; k < n; k++) {
		const double r = (double)x[0][k], s = (double)x[1][k], t = (double)x[2][k], w = 1 / (1 + (r * r + s * s + t * t));
		sums[0] += w * r * r;
		sums[1] += w * r * s;
		sums[2] += w * r * t;
		sums[3] += w * s * s;
		sums[4] += w * s * t;
		sums[5] += w * t * t;
	}
}

/*
 * n cells of one channel. The limits are those of the numbers as integers, which is the same for positive ones and takes half the
 * instructions; negative ones become 0. No field is NaN: coefficients are within 2^98, their sums far within the range of float.
 */
static ALWAYS_INLINE void KERNEL(channel_values)(const float *const field[3], size_t at, size_t n, float base,
                                                 const float rotation[3], float most, float *restrict out)
{
	const float *a = field[0] + at, *b = field[1] + at, *d = field[2] + at;
	const int32_t limit = (int32_t)bits_of_float(most);

	for (size_t k = 0; k < n; k++) {
		int32_t l = (int32_t)bits_of_float(base + (rotation[0] * a[k] + rotation[1] * b[k] + rotation[2] * d[k]));
		l = l < 0 ? 0 : l;
		l = l > limit ? limit : l;
		out[k] = fast_exp2f(float_of_bits((uint32_t)l)) - 1;
	}
}

static void KERNEL(spectral_values)(const float *const field[3], size_t width, const float base[3], const float rotation[3][3],
                                    float most, float *const rgb[3])
{
	for (int c = 0; c < 3; c++)
		KERNEL(channel_values)(field, 0, width, base[c], (const float[3]){rotation[0][c], rotation[1][c], rotation[2][c]}, most,
		                       rgb[c]);
}

typedef uint16_t KERNEL(codes8) __attribute__((vector_size(16)));

/* 16 values as codes in units of 2^39. */
static ALWAYS_INLINE void KERNEL(channel_codes)(const float *value, uint16_t *restrict out)
{
	for (int k = 0; k < 16; k++) {
		int32_t code = (int32_t)((bits_of_float(value[k]) + 0x1000) >> 13) - ((127 + 39 - 63) << 10);
		code = code < 1 << 10 ? 0 : code;
		out[k] = (uint16_t)(code > 65535 ? 65535 : code);
	}
}

/* Eight cells' R, G and B side by side. */
static ALWAYS_INLINE void KERNEL(codes_interleave)(const uint16_t *rgb, size_t channel, uint16_t *out)
{
	KERNEL(codes8) r, g, b, first, second, third;
	memcpy(&r, rgb, sizeof r);
	memcpy(&g, rgb + channel, sizeof g);
	memcpy(&b, rgb + 2 * channel, sizeof b);
	first = __builtin_shufflevector(r, g, 0, 8, 0, 1, 9, 0, 2, 10);
	second = __builtin_shufflevector(r, g, 0, 3, 11, 0, 4, 12, 0, 5);
	third = __builtin_shufflevector(r, g, 13, 0, 6, 14, 0, 7, 15, 0);
	first = __builtin_shufflevector(first, b, 0, 1, 8, 3, 4, 9, 6, 7);
	second = __builtin_shufflevector(second, b, 10, 1, 2, 11, 4, 5, 12, 7);
	third = __builtin_shufflevector(third, b, 0, 13, 2, 3, 14, 5, 6, 15);
	memcpy(out, &first, sizeof first);
	memcpy(out + 8, &second, sizeof second);
	memcpy(out + 16, &third, sizeof third);
}

static void KERNEL(spectral_codes)(const float *const field[3], size_t width, const float base[3], const float rotation[3][3],
                                   float most, int channels, uint16_t *out)
{
	enum { BLOCK = 16 };
	const float weight[3][3] = {{rotation[0][0], rotation[1][0], rotation[2][0]},
	                            {rotation[0][1], rotation[1][1], rotation[2][1]},
	                            {rotation[0][2], rotation[1][2], rotation[2][2]}};
	float value[3][BLOCK];
	uint16_t code[3 * BLOCK], mixed[3 * BLOCK];

	for (size_t k = 0; k < width; k += BLOCK) {
		const size_t count = width - k < BLOCK ? width - k : BLOCK;
		uint16_t *to = out + (size_t)channels * k;
		for (int c = 0; c < 3; c++)
			KERNEL(channel_values)(field, k, BLOCK, base[c], weight[c], most, value[c]);
		if (channels == 3) {
			for (int c = 0; c < 3; c++)
				KERNEL(channel_codes)(value[c], code + c * BLOCK);
			KERNEL(codes_interleave)(code, BLOCK, mixed);
			KERNEL(codes_interleave)(code + 8, BLOCK, mixed + 24);
		} else {
			for (int n = 0; n < BLOCK; n++)
				value[0][n] = (value[0][n] + value[1][n] + value[2][n]) * (1.0f / 3);
			KERNEL(channel_codes)(value[0], mixed);
		}
		if (count == BLOCK && channels == 3)
			memcpy(to, mixed, sizeof mixed);
		else
			memcpy(to, mixed, count * (size_t)channels * sizeof *mixed);
	}
}

static void KERNEL(spectral_rotate)(float *const x[3], size_t n, const float m[3][3])
{
	float *restrict a = x[0], *restrict b = x[1], *restrict c = x[2];

	for (size_t k = 0; k < n; k++) {
		const float r = a[k], s = b[k], t = c[k];
		a[k] = m[0][0] * r + m[0][1] * s + m[0][2] * t;
		b[k] = m[1][0] * r + m[1][1] * s + m[1][2] * t;
		c[k] = m[2][0] * r + m[2][1] * s + m[2][2] * t;
	}
}

static void KERNEL(spectral_smooth)(float *x, const float *filled, const float *const neighbour[4], size_t n, float before,
                                    float after)
{
	const float *a = neighbour[0], *b = neighbour[1], *c = neighbour[2], *d = neighbour[3];
	const size_t whole = n / 8 * 8;

	if (whole) {
		/* What is left of the next vector is read before this one is written. */
		floats8 here = FLOATS8_LOAD(x), left = __builtin_shufflevector((floats8){before}, here, 0, 8, 9, 10, 11, 12, 13, 14);
		for (size_t k = 0; k < whole; k += 8) {
			const floats8 right =
				k + 8 < n ? FLOATS8_LOAD(x + k + 1) : __builtin_shufflevector(here, (floats8){after}, 1, 2, 3, 4, 5, 6, 7, 8);
			floats8 next = here, next_left = left;
			if (k + 8 < whole) {
				next = FLOATS8_LOAD(x + k + 8);
				next_left = FLOATS8_LOAD(x + k + 7);
			}
			before = x[k + 7];
			const floats8 sum =
				4 * (left + right) + ((FLOATS8_LOAD(a + k) + FLOATS8_LOAD(b + k)) + (FLOATS8_LOAD(c + k) + FLOATS8_LOAD(d + k)));
			FLOATS8_STORE(x + k, here + FLOATS8_LOAD(filled + k) * (sum * (1.0f / 12) - here));
			here = next;
			left = next_left;
		}
	}
	for (size_t k = whole; k < n; k++) {
		const float here = x[k], right = k + 1 < n ? x[k + 1] : after;
		x[k] = here + filled[k] * ((4 * (before + right) + ((a[k] + b[k]) + (c[k] + d[k]))) * (1.0f / 12) - here);
		before = here;
	}
}

static void KERNEL(spectral_shrink)(float *x, const float *const square[3], size_t stride, const float *factor, float threshold,
                                    size_t n)
{
	const float *a = square[0], *b = square[1], *c = square[2];

	for (size_t q = 0; q < n; q++) {
		const float *u = a + q, *v = b + q, *w = c + q;
		const float left = u[0] + v[0] + w[0], here = u[stride] + v[stride] + w[stride],
					right = u[2 * stride] + v[2 * stride] + w[2 * stride];
		const float energy = left + here + right + 0.5f * (v[stride - 1] + v[stride + 1]);
		float keep = 1 - threshold * factor[q] / (energy + 1e-30f);
		x[q] *= keep > 0 ? keep : 0;
	}
}

/* ---- what errors of many values are worth: spectral_weights_find.c ---- */

static void KERNEL(spectral_log2s)(double *x, size_t n)
{
	for (size_t i = 0; i < n; i++)
		x[i] = fast_log2(x[i]);
}

static void KERNEL(spectral_worths)(const double *radiance, size_t n, const struct spectral_light *lights, size_t light_count,
                                    double ambient, double *restrict out)
{
	for (size_t i = 0; i < n; i++)
		out[i] = 0;
	for (size_t l = 0; l < light_count; l++) {
		const double light = lights[l].radiance, count = lights[l].count;
		for (size_t i = 0; i < n; i++) {
			/* A pixel x + ambient, x being this light's; the curve is a power of 1/2.4. Above white there is nothing to see. */
			const double x = radiance[i] * light, share = x + 0.02 * light;
			const double slope = fast_exp2(2 * (1 / 2.4 - 1) * fast_log2(x + ambient)), dimmed = slope / (x * x);
			out[i] += count * (x > 1 ? dimmed : slope) * share * share;
		}
	}
}
