/*
 * trilinear.h: the slow reference of a look-up, in double, from the expansion itself; and angles to directions by rotation,
 * so that nothing of direction.h is taken for granted.
 */
#ifndef TESTS_TRILINEAR_H
#define TESTS_TRILINEAR_H

#include <math.h>

#include "model/table/direction.h"

/* One pair of directions as the kernels place it. False, and *out 0, where it is unusable. */
static inline bool direction_to_lattice(struct lattice_dims dims, const float wi[3], const float wo[3], struct lattice_point *out)
{
	f32x4 at;
	*out = (struct lattice_point){0};
	if (!direction_locate(lattice_scale_of(dims), wi, wo, &at))
		return false;
	*out = (struct lattice_point){at[0], at[1], at[2]};
	return true;
}

/* The value of cell (i, j, k), of the first or last one where there is none along theta_h or theta_d. */
static inline double cell_value(const struct expansion *e, int channel, int i, int j, int k)
{
	const int last_i = (int)e->dims.theta_h - 1, last_j = (int)e->dims.theta_d - 1, period = (int)e->dims.phi_d;
	i = i < 0 ? 0 : i > last_i ? last_i : i;
	j = j < 0 ? 0 : j > last_j ? last_j : j;
	return (double)e->rgb[channel][lattice_index(e->dims, (uint32_t)i, (uint32_t)j, (uint32_t)((k + period) % period))] * e->unit;
}

/* Between values that stand at `first` and every cell from there: 0.5, or 0.25 where they are every second one of another table. */
static inline double trilinear(const struct expansion *e, int channel, struct lattice_point at, double first)
{
	double h = (double)at.h - first, d = (double)at.d - first, p = (double)at.p - first, sum = 0;
	const int i = (int)floor(h), j = (int)floor(d), k = (int)floor(p);
	h -= i, d -= j, p -= k;
	for (int n = 0; n < 8; n++)
		sum += (n & 1 ? h : 1 - h) * (n & 2 ? d : 1 - d) * (n & 4 ? p : 1 - p) *
		       cell_value(e, channel, i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
	return sum;
}

/* Rusinkiewicz's angles, phi_h = 0, of coordinates in cells. False where a direction is not above the horizon. */
static inline bool directions_at(struct lattice_dims dims, double h, double d, double p, float wi[3], float wo[3])
{
	const double theta_h = h * h / ((double)dims.theta_h * dims.theta_h) * M_PI_2, theta_d = d / dims.theta_d * M_PI_2;
	const double phi_d = p / dims.phi_d * M_PI, x = sin(theta_d) * cos(phi_d), y = sin(theta_d) * sin(phi_d), z = cos(theta_d);
	for (int sign = -1; sign <= 1; sign += 2) {
		float *w = sign > 0 ? wi : wo;
		w[0] = (float)(cos(theta_h) * sign * x + sin(theta_h) * z);
		w[1] = (float)(sign * y);
		w[2] = (float)(cos(theta_h) * z - sin(theta_h) * sign * x);
	}
	return wi[2] > 1e-3f && wo[2] > 1e-3f;
}

#endif
