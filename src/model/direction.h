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
 * Everything here is inline: the evaluation kernels are compiled once plain and once for AVX2,
 * and the loops over it vectorise. The arithmetic is the same in every form.
 */
#ifndef MODEL_DIRECTION_H
#define MODEL_DIRECTION_H

#include <float.h>
#include <math.h>

#include "../merl/lattice.h"
#include "fast_math.h"

/* Where a pair of directions falls: coordinates in cells. p = P means the same as p = 0. */
struct lattice_point {
	float h, d, p;
};

/* The lattice's extents, as the arithmetic wants them. */
struct lattice_scale {
	float h, d, p;
};

static inline struct lattice_scale lattice_scale_of(struct lattice_dims dims)
{
	return (struct lattice_scale){(float)dims.theta_h, (float)dims.theta_d, (float)dims.phi_d};
}

/* (2/pi) atan(t)/t for q = t^2 in [0, 1]: Chebyshev fit of degree 7; with its rounding the relative error is below 3e-7. */
#define QUARTER_TURNS_POLYNOMIAL(q)                                                                                            \
	(((((((-0.00290285377f * (q) + 0.0151391486f) * (q) - 0.0374521837f) * (q) + 0.0628271475f) * (q) - 0.0891477168f) * (q) + \
	   0.127113625f) * (q) - 0.212196916f) * (q) + 0.636619687f)

/* (2/pi) atan2(y, x) for x, y >= 0, in [0, 1]; 0 for (0, 0). */
static inline float quarter_turns(float y, float x)
{
	float low = y > x ? x : y, high = y > x ? y : x;
	float t = low / (high > FLT_MIN ? high : FLT_MIN), q = t * t;
	float a = QUARTER_TURNS_POLYNOMIAL(q) * t;
	return fabsf((y > x ? 1.0f : 0.0f) - a); /* 1 - a or a, without a branch */
}

typedef float f32x4 __attribute__((vector_size(16)));
typedef int32_t i32x4 __attribute__((vector_size(16)));
#define SELECT_X4(mask, yes, no) ((f32x4)(((i32x4)(yes) & (mask)) | ((i32x4)(no) & ~(mask))))

/* The same for four at once, to the bit. */
static inline f32x4 quarter_turns_x4(f32x4 y, f32x4 x)
{
	const f32x4 least = {FLT_MIN, FLT_MIN, FLT_MIN, FLT_MIN};
	i32x4 steep = y > x;
	f32x4 low = SELECT_X4(steep, x, y), high = SELECT_X4(steep, y, x);
	f32x4 t = low / SELECT_X4(high > least, high, least), q = t * t;
	f32x4 a = QUARTER_TURNS_POLYNOMIAL(q) * t;
	return SELECT_X4(steep, 1 - a, a);
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

/* Arguments (y, x) of the three arctangents, of unit vectors; phi_d's signs are split off. */
struct direction_arguments {
	float y[3], x[3]; /* theta_h, theta_d, |phi_d| */
	float reflected;  /* 1: phi_d = pi - what [2] gives; else 0 */
};

static inline struct direction_arguments direction_arguments(float ix, float iy, float iz, float ox, float oy, float oz)
{
	float sx = ix + ox, sy = iy + oy, sz = iz + oz;
	float dx = ix - ox, dy = iy - oy, dz = iz - oz;
	float ring = sx * sx + sy * sy;
	float s = sqrtf(ring + sz * sz), d = sqrtf(dx * dx + dy * dy + dz * dz);
	bool at_pole = ring == 0;
	float y = at_pole ? dy : sx * dy - sy * dx, x = at_pole ? dx : -dz * s;
	return (struct direction_arguments){
		{sqrtf(ring), d, fabsf(y)}, {sz, s, fabsf(x)},
		/*
		 * 1 where the signs differ; on the axes (one of them 0) both ways give the same angle mod pi. By bits,
		 * because compilers make a branch of it otherwise, which no predictor can guess.
		 */
		float_of_bits((0 - ((bits_of_float(y) ^ bits_of_float(x)) >> 31)) & 0x3f800000)};
}

/* The point, from the three arctangents in quarter turns. */
static inline struct lattice_point direction_point(struct lattice_scale scale, float theta_h, float theta_d, float phi_d, float reflected)
{
	/* no branch on a coin toss: |1 - x| for the reflected, |0 - x| for the others */
	return (struct lattice_point){sqrtf(theta_h) * scale.h, theta_d * scale.d, fabsf(reflected - 0.5f * phi_d) * scale.p};
}

/* One pair of directions. Returns false, and leaves *out unset, where direction_usable says so. */
bool direction_to_lattice(struct lattice_dims dims, const float wi[3], const float wo[3], struct lattice_point *out);

/* The same inline, for the kernels. */
static inline bool direction_locate(struct lattice_scale scale, const float wi[3], const float wo[3], struct lattice_point *out)
{
	float squared_i = wi[0] * wi[0] + wi[1] * wi[1] + wi[2] * wi[2];
	float squared_o = wo[0] * wo[0] + wo[1] * wo[1] + wo[2] * wo[2];
	if (!direction_usable(wi[2], squared_i, wo[2], squared_o))
		return false;
	float ni = direction_normaliser(squared_i), no = direction_normaliser(squared_o);
	struct direction_arguments a =
		direction_arguments(wi[0] * ni, wi[1] * ni, wi[2] * ni, wo[0] * no, wo[1] * no, wo[2] * no);
	f32x4 turns = quarter_turns_x4((f32x4){a.y[0], a.y[1], a.y[2], 0}, (f32x4){a.x[0], a.x[1], a.x[2], 0});
	*out = direction_point(scale, turns[0], turns[1], turns[2], a.reflected);
	return true;
}

#endif
