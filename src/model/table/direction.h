/*
 * direction.h: a pair of directions -> coordinates on the lattice, in cells.
 *
 * With unit wi, wo, s = wi + wo and d = wi - wo (so s.d = 0), r = hypot(sx, sy):
 *
 *     theta_h = atan2(r, sz)      theta_d = atan2(|d|, |s|)
 *     phi_d   = atan2(sx dy - sy dx, -dz |s|), plus pi where negative (reciprocity)
 *
 * which is Rusinkiewicz's definition with every rotation multiplied out: no sine, cosine or
 * arccosine, and nothing is lost to cancellation near theta = 0. Where theta_h is 0, phi_h is
 * undefined and taken as 0, so phi_d = atan2(dy, dx); where wi = wo, phi_d = 0.
 *
 *     h = H sqrt(theta_h / (pi/2)) in [0, H]   d = D theta_d / (pi/2) in [0, D]   p = P phi_d / pi in [0, P]
 *
 * Each arctangent takes the squares of its arguments, t = y^2/x^2: one division for all three, and
 * the root of t runs beside the polynomial in t.
 *
 * Everything here is inline: the evaluation kernels are compiled once plain and once for AVX2. For
 * loops over many pairs there are scalar functions, which vectorise; for one pair direction_locate
 * with its vectors of four. The arithmetic is the same in every form.
 */
#ifndef MODEL_TABLE_DIRECTION_H
#define MODEL_TABLE_DIRECTION_H

#include <float.h>
#include <math.h>

#include "merl/lattice.h"
#include "model/math/fast_math.h"

/* Where a pair of directions falls: coordinates in cells. p = P means the same as p = 0. */
struct lattice_point {
	float h, d, p;
};

/*
 * (2/pi) atan(t)/t for q = t^2 in [0, 1]: Chebyshev fit of degree 7; with its rounding the relative error is below 4e-7.
 * In pairs, not by Horner's rule: a single evaluation waits for it, and this takes half as long.
 */
#define QUARTER_TURNS_7 -0.00290285377f
#define QUARTER_TURNS_6 0.0151391486f
#define QUARTER_TURNS_5 -0.0374521837f
#define QUARTER_TURNS_4 0.0628271475f
#define QUARTER_TURNS_3 -0.0891477168f
#define QUARTER_TURNS_2 0.127113625f
#define QUARTER_TURNS_1 -0.212196916f
#define QUARTER_TURNS_0 0.636619687f

static inline float quarter_turns_polynomial(float q)
{
	float q2 = q * q;
	return ((QUARTER_TURNS_7 * q + QUARTER_TURNS_6) * q2 + (QUARTER_TURNS_5 * q + QUARTER_TURNS_4)) * (q2 * q2) +
	       ((QUARTER_TURNS_3 * q + QUARTER_TURNS_2) * q2 + (QUARTER_TURNS_1 * q + QUARTER_TURNS_0));
}

/*
 * scale (2/pi) atan2(sqrt(y), sqrt(x)) for x, y >= 0; 0 for (0, 0). From squares, so that the root runs beside the polynomial,
 * not before the division.
 */
static inline float quarter_turns_of_squares(float y, float x, float scale)
{
	float low = y > x ? x : y, high = y > x ? y : x;
	float q = low / (high > FLT_MIN ? high : FLT_MIN);
	float a = quarter_turns_polynomial(q) * (sqrtf(q) * scale);
	return fabsf((y > x ? scale : 0.0f) - a);
}

typedef float f32x4 __attribute__((vector_size(16)));
typedef int32_t i32x4 __attribute__((vector_size(16)));
#define SELECT_X4(mask, yes, no) ((f32x4)(((i32x4)(yes) & (mask)) | ((i32x4)(no) & ~(mask))))

/* Lane by lane a < b ? a : b, a > b ? a : b, the root and the magnitude: one instruction each where there is one. */
#ifdef __SSE2__
#include <emmintrin.h>
static inline f32x4 min_x4(f32x4 a, f32x4 b) { return (f32x4)_mm_min_ps((__m128)a, (__m128)b); }
static inline f32x4 max_x4(f32x4 a, f32x4 b) { return (f32x4)_mm_max_ps((__m128)a, (__m128)b); }
static inline f32x4 sqrt_x4(f32x4 a) { return (f32x4)_mm_sqrt_ps((__m128)a); }
#else
static inline f32x4 min_x4(f32x4 a, f32x4 b) { return SELECT_X4(a < b, a, b); }
static inline f32x4 max_x4(f32x4 a, f32x4 b) { return SELECT_X4(a > b, a, b); }
static inline f32x4 sqrt_x4(f32x4 a) { return (f32x4){sqrtf(a[0]), sqrtf(a[1]), sqrtf(a[2]), sqrtf(a[3])}; }
#endif
static inline f32x4 abs_x4(f32x4 a) { return (f32x4)((i32x4)a & 0x7fffffff); }

/* (x, y, z, 0) */
static inline f32x4 load_xyz(const float w[3])
{
#ifdef __SSE2__ /* two loads, of which gcc 12 makes five instructions */
	f32x4 v = (f32x4)_mm_loadl_epi64((const __m128i *)(const void *)w);
	v[2] = w[2];
	return v;
#else
	return (f32x4){w[0], w[1], w[2], 0};
#endif
}

/* Whether a comparison holds in all lanes. */
#ifdef __SSE2__
static inline bool all_x4(i32x4 mask) { return _mm_movemask_ps((__m128)mask) == 15; }
#else
static inline bool all_x4(i32x4 mask) { return (mask[0] & mask[1] & mask[2] & mask[3]) != 0; }
#endif

/* What the three arctangents in quarter turns are multiplied by: (H^2, D, P/2, 0), before the root of the first is taken. */
static inline f32x4 lattice_scale_of(struct lattice_dims dims)
{
	return (f32x4){(float)dims.theta_h * (float)dims.theta_h, (float)dims.theta_d, 0.5f * (float)dims.phi_d, 0};
}

/* FLT_MIN and the polynomial's coefficients, in all lanes: in memory, where compilers would rather spread them anew each time. */
extern const f32x4 quarter_turns_x4[9] __attribute__((visibility("hidden")));

/* quarter_turns_of_squares for four at once, to the bit. */
static inline f32x4 quarter_turns_of_squares_x4(f32x4 y, f32x4 x, f32x4 scale)
{
	const f32x4 *c = quarter_turns_x4;
	f32x4 q = min_x4(x, y) / max_x4(max_x4(y, x), c[0]), q2 = q * q, root = sqrt_x4(q) * scale;
	f32x4 a = (((c[1] * q + c[2]) * q2 + (c[3] * q + c[4])) * (q2 * q2) + ((c[5] * q + c[6]) * q2 + (c[7] * q + c[8]))) * root;
	return abs_x4((f32x4)((i32x4)scale & (y > x)) - a);
}

/* Squared length that still counts as 1: what rounding to float leaves of a normalised vector. */
#define DIRECTION_UNIT_SLACK 1e-6f

/* The factor that makes a vector of this squared length a unit vector. */
static inline float direction_normaliser(float squared)
{
	return fabsf(squared - 1) < DIRECTION_UNIT_SLACK ? 1 : 1 / sqrtf(squared);
}

/* Both directions above the horizon, neither zero, infinite nor NaN, lengths within about 1e-18..1e18. */
static inline bool direction_usable(float z_i, float squared_i, float z_o, float squared_o)
{
	/* every comparison is false for NaN; & keeps the expression free of branches */
	return (z_i > 0) & (z_o > 0) & (squared_i < FLT_MAX) & (squared_o < FLT_MAX) & (squared_i > FLT_MIN) & (squared_o > FLT_MIN);
}

/* Squares of the arguments (y, x) of the three arctangents, of unit vectors; phi_d's signs are split off. */
struct direction_arguments {
	float y[3], x[3]; /* theta_h, theta_d, |phi_d| */
	bool reflected;   /* phi_d = pi - what [2] gives */
};

static inline struct direction_arguments direction_arguments(float ix, float iy, float iz, float ox, float oy, float oz)
{
	float sx = ix + ox, sy = iy + oy, sz = iz + oz;
	float dx = ix - ox, dy = iy - oy, dz = iz - oz;
	float ring = sx * sx + sy * sy, up = sz * sz, s = ring + up, d = (dx * dx + dy * dy) + dz * dz;
	bool at_pole = ring < FLT_MIN;
	float y = at_pole ? dy : sx * dy - sy * dx, x = at_pole ? -dx : dz;
	/* on the axes (x or y is 0) both ways give the same angle mod pi */
	return (struct direction_arguments){{ring, d, y * y}, {up, s, x * x * (at_pole ? 1 : s)}, y * x > 0};
}

/* The point, for lattice_scale_of's scale. */
static inline struct lattice_point direction_point(const struct direction_arguments *a, const float scale[3])
{
	float h = quarter_turns_of_squares(a->y[0], a->x[0], scale[0]), d = quarter_turns_of_squares(a->y[1], a->x[1], scale[1]);
	float p = quarter_turns_of_squares(a->y[2], a->x[2], scale[2]);
	return (struct lattice_point){sqrtf(h), d, fabsf((a->reflected ? 2 * scale[2] : 0) - p)};
}

/*
 * One pair of directions; false, and nothing set, where direction_usable says so. As vectors of which *squared begins with h^2,
 * and *out is (meaningless, d, p, 0): for the kernels. Few operations, because a single look-up waits for all of them; and what
 * does not need h need not wait for its root.
 */
static inline bool direction_locate_squared(f32x4 scale, const float wi[3], const float wo[3], f32x4 *squared, f32x4 *out)
{
	const f32x4 none = {0, 0, 0, 0}, slack = {DIRECTION_UNIT_SLACK, DIRECTION_UNIT_SLACK, 0, 0}, one = {1, 1, 0, 0};
	f32x4 i = load_xyz(wi), o = load_xyz(wo), s, d, flat, up, length;
	for (bool again = false;; again = true) {
		s = i + o;
		d = i - o;
		/* sums over x, y, z of the squares of i, o, s, d at once */
		const f32x4 ii = i * i, oo = o * o, ss = s * s, dd = d * d;
		const f32x4 io = __builtin_shufflevector(ii, oo, 0, 4, 1, 5), sd = __builtin_shufflevector(ss, dd, 0, 4, 1, 5);
		flat = __builtin_shufflevector(io, sd, 0, 1, 4, 5) + __builtin_shufflevector(io, sd, 2, 3, 6, 7);
		up = __builtin_shufflevector(__builtin_shufflevector(ii, oo, 2, 6, 3, 7), __builtin_shufflevector(ss, dd, 2, 6, 3, 7), 0,
		                             1, 4, 5);
		length = flat + up;
		/* |i|^2 and |o|^2 nearly 1, 0 below i.z and o.z */
		const f32x4 off = (f32x4)((i32x4)(length - one) & (i32x4){0x7fffffff, 0x7fffffff, 0, 0});
		if (again || all_x4(off < __builtin_shufflevector(slack, __builtin_shufflevector(i, o, 2, 6, 3, 7), 0, 1, 4, 5)))
			break;
		if (!direction_usable(wi[2], length[0], wo[2], length[1]))
			return false;
		i *= direction_normaliser(length[0]);
		o *= direction_normaliser(length[1]);
	}
	/* the arguments of the arctangents; the last lane is of no use */
	const f32x4 cross = s * __builtin_shufflevector(d, d, 1, 0, 2, 3),
				y = cross - __builtin_shufflevector(cross, cross, 1, 1, 1, 1);
	const f32x4 flat_length = __builtin_shufflevector(flat, length, 2, 6, 3, 7);
	f32x4 factor = {1, 1, 1, 1}, top = __builtin_shufflevector(flat_length, y * y, 0, 3, 4, 4);
	factor[2] = length[2];
	f32x4 bottom = __builtin_shufflevector(up, length, 2, 6, 3, 7) * factor, sign = __builtin_shufflevector(y, y, 0, 0, 0, 0) * d;
	if (flat_length[0] < FLT_MIN) { /* theta_h is 0 */
		top[2] = d[1] * d[1];
		bottom[2] = d[0] * d[0];
		sign[2] = d[1] * -d[0];
	}
	const f32x4 turns = quarter_turns_of_squares_x4(top, bottom, scale);
	*squared = turns;
	*out = abs_x4((f32x4)((i32x4)(scale * (f32x4){0, 0, 2, 0}) & (sign > none)) - turns);
	return true;
}

/* (h, d, p, 0). */
static inline bool direction_locate(f32x4 scale, const float wi[3], const float wo[3], f32x4 *out)
{
	f32x4 squared, at;
	if (!direction_locate_squared(scale, wi, wo, &squared, &at))
		return false;
	at[0] = sqrtf(squared[0]);
	*out = at;
	return true;
}

#endif
