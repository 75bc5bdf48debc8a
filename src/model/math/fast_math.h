/*
 * fast_math.h: logarithm, exponential and cube root without branches or tables, for hot loops.
 *
 * Plain C that compilers turn into vector code when it stands in a loop over arrays. Only additions,
 * multiplications, divisions and integer operations are used, each correctly rounded, so the results
 * are the same on every processor and at every vector width (which libm does not promise).
 *
 * Error bounds are measured against long double over the whole stated range (tests/test_fast_math.c).
 */
#ifndef MODEL_MATH_FAST_MATH_H
#define MODEL_MATH_FAST_MATH_H

#include <stdint.h>
#include <string.h>

static inline uint64_t bits_of_double(double x)
{
	uint64_t u;
	memcpy(&u, &x, sizeof u);
	return u;
}
static inline double double_of_bits(uint64_t u)
{
	double x;
	memcpy(&x, &u, sizeof x);
	return x;
}
static inline uint32_t bits_of_float(float x)
{
	uint32_t u;
	memcpy(&u, &x, sizeof u);
	return u;
}
static inline float float_of_bits(uint32_t u)
{
	float x;
	memcpy(&x, &u, sizeof x);
	return x;
}

/*
 * log2(x) for normal positive x. Error at most 4e-16 (|log2 x| <= 1) or 1 ulp of the result more.
 * Infinity gives 1024, zero a value below -1022; a negative x gives nonsense, never a trap.
 *
 * x = m 2^e with m in [sqrt 1/2, sqrt 2); log2 m = (2/ln 2) atanh s, s = (m - 1)/(m + 1), |s| < 0.1716, by the
 * polynomial in s^2 of least relative error there (2e-16; the Remez exchange).
 */
static inline double fast_log2(double x)
{
	const uint64_t root_half = 0x3fe6a09e667f3bcdu, one = 0x3ff0000000000000u, mantissa = 0x000fffffffffffffu;
	uint64_t u = bits_of_double(x) + (one - root_half);
	double m = double_of_bits((u & mantissa) + root_half);
	double exponent = double_of_bits(u >> 52 | 0x4330000000000000u) - (4503599627370496.0 + 1023.0); /* 2^52 + e + 1023 */
	double s = (m - 1) / (m + 1), z = s * s;
	double q = z * z; /* even and odd powers of z apart: half as long a chain */
	double even = 0.24292899848126762, odd = 0.26144310975340385;
	even = even * q + 0.32061642584090355;
	odd = odd * q + 0.41219840147329406;
	even = even * q + 0.57707801725029029;
	odd = odd * q + 0.96179669392432454;
	even = even * q + 2.8853900817779272;
	return exponent + s * (even + z * odd);
}

/* log2(x) for normal positive float x. Error at most 1.5e-7 (|log2 x| <= 1), or 1 ulp of the result more; a series to s^9. */
static inline float fast_log2f(float x)
{
	const uint32_t root_half = 0x3f3504f3u, one = 0x3f800000u;
	uint32_t u = bits_of_float(x);
	uint32_t e = (u - root_half + one) >> 23;
	float m = float_of_bits(u - (e << 23) + one);
	float exponent = (float)((int32_t)e - 127);
	float s = (m - 1) / (m + 1), z = s * s;
	float p = 1.0f / 9;
	p = p * z + 1.0f / 7;
	p = p * z + 1.0f / 5;
	p = p * z + 1.0f / 3;
	return exponent + (s * 2.88539008f + (s * z) * p * 2.88539008f);
}

/*
 * 2^x for x clamped to [-1022, 1023]. Relative error at most 4e-16.
 * x = n + f, |f| <= 1/2; the Taylor series of 2^f is cut after f^13, the rest is below 2e-17.
 */
static inline double fast_exp2(double x)
{
	x = x < -1022 ? -1022 : x;
	x = x > 1023 ? 1023 : x;
	double shifted = x + 6755399441055744.0; /* 1.5 2^52: rounds x to an integer in the low bits */
	double f = (x - (shifted - 6755399441055744.0)) * 0.69314718055994531;
	double p = 1.0 / 6227020800;
	p = p * f + 1.0 / 479001600;
	p = p * f + 1.0 / 39916800;
	p = p * f + 1.0 / 3628800;
	p = p * f + 1.0 / 362880;
	p = p * f + 1.0 / 40320;
	p = p * f + 1.0 / 5040;
	p = p * f + 1.0 / 720;
	p = p * f + 1.0 / 120;
	p = p * f + 1.0 / 24;
	p = p * f + 1.0 / 6;
	p = p * f + 0.5;
	p = p * f + 1;
	p = p * f + 1;
	return p * double_of_bits((bits_of_double(shifted) + 1023) << 52);
}

/*
 * 2^x for float x in [-126, 127]. Relative error at most 2e-7; 1 for 0. x = n + f, |f| <= 1/2; 2^f = 1 + f q(f), q the polynomial
 * through (2^f - 1)/f at six Chebyshev nodes (1e-8), its pairs of terms side by side, so that none waits for another.
 */
static inline float fast_exp2f(float x)
{
	float shifted = x + 12582912.0f; /* 1.5 2^23 */
	float f = x - (shifted - 12582912.0f), z = f * f;
	float q = (0.693147182f + 0.240226507f * f) +
	          z * ((0.0555035695f + 0.00961808302f * f) + z * (0.00133908633f + 0.000154531634f * f));
	return (1 + f * q) * float_of_bits((bits_of_float(shifted) + 127) << 23);
}

/*
 * Cube root of x >= 0. Relative error at most 1e-15 for normal x; 0 for 0; denormal x: below 2e-102.
 *
 * r = x^(-1/3) times 0.874 to 0.926 from a third of the exponent bits; then r times the cubic of least relative error
 * (1e-6; the Remez exchange) for y^(-1/3), y = x r^3. Of the root t = x r^2 what is missing is the factor
 * (1 - e)^(-2/3) = 1 + 2 e/3 + 5 e^2/9 + ..., e = 1 - x r^3. No division.
 */
static inline double fast_cbrt(double x)
{
	/* The upper half word as a double divides by 3 without 64-bit integer multiplication. */
	const double two52 = 4503599627370496.0;
	double high = double_of_bits(bits_of_double(x) >> 32 | 0x4330000000000000u); /* 2^52 more */
	double r = double_of_bits(bits_of_double(two52 + two52 / 3 + 1430026250.0 - high * (1.0 / 3)) << 32);
	double y = x * r * (r * r);
	double p = -0.49460553522193418;
	p = p * y + 1.5485197338761671;
	p = p * y - 1.9772386093983887;
	p = p * y + 1.9211904256557717;
	r = r * p;
	double t = x * r * r, e = 1 - t * r;
	return t + t * (e * (2.0 / 3 + e * (5.0 / 9)));
}

#endif
