/* horizon_s.h: how far the half-angle may lie from the normal; see sample.h for s. */
#ifndef MODEL_SAMPLE_HORIZON_S_H
#define MODEL_SAMPLE_HORIZON_S_H

#include <math.h>

#include "model/math/fast_math.h"

/* By bits, because compilers make a branch of it otherwise, which no predictor can guess. */
static inline float horizon_choice(uint32_t all_bits, float yes, float no)
{
	return float_of_bits((bits_of_float(yes) & all_bits) | (bits_of_float(no) & ~all_bits));
}

/*
 * The largest s at which wi is above the horizon, for wo at (sine, cosine) and cos phi_h; cosine at least 1e-6.
 *
 * With f = |sine cos phi|, r^2 = f^2 + cosine^2 and sin psi = f/r (negative where cos phi is), sin^2 theta_max = (1 + sin psi)/2,
 * and s = sin^2(theta_max/2). Without cancellation, and multiplied out to one division, with g = r (r + f):
 *     s = (r + f) sqrt(g) / (4 r (sqrt(g) + cosine sqrt(1/2)))                 where cos phi >= 0
 *     s = cosine^2 / (4 sqrt(g) (sqrt(g) + (r + f) sqrt(1/2)))                 where cos phi < 0
 */
static inline float horizon_s(float sine, float cosine, float cos_phi)
{
	const float root_half = 0.707106781f;
	float forward = sine * cos_phi, f = fabsf(forward), r = sqrtf(forward * forward + cosine * cosine), sum = r + f,
		  g = sqrtf(r * sum);
	uint32_t back = 0 - (bits_of_float(cos_phi) >> 31);
	float low = horizon_choice(back, g, r) * (g + horizon_choice(back, sum, cosine) * root_half);
	return 0.25f * horizon_choice(back, cosine * cosine, sum * g) / low;
}

#endif
