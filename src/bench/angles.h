/*
 * angles.h: the benchmark's geometry: half/difference angles of a cell and of a pair of directions.
 *
 * A stored value stands for its cell's centre (merl/lattice.h).
 */
#ifndef BENCH_ANGLES_H
#define BENCH_ANGLES_H

#include <math.h>

#include "merl/lattice.h"

/* What the analytic models look at. */
struct cell_angles {
	double cos_i, cos_o; /* of incoming and outgoing direction; may be <= 0 where theta_h and theta_d are large */
	double cos_h;        /* of theta_h */
	double cos_d;        /* of theta_d = the angle between either direction and the half vector */
};

/*
 * Rusinkiewicz (1998), with phi_h = 0: the half vector is (sin_h, 0, cos_h), wi is (theta_d, phi_d)
 * about it and wo its mirror image, so cos_i, cos_o = cos_h cos_d -+ sin_h sin_d cos_p.
 */
static inline struct cell_angles cell_angles_at(const struct lattice_cosines *t, uint32_t i, uint32_t j, uint32_t k)
{
	double a = t->cos_h[i] * t->cos_d[j], b = t->sin_h[i] * t->sin_d[j] * t->cos_p[k];

	return (struct cell_angles){a - b, a + b, t->cos_h[i], t->cos_d[j]};
}

/* The same from directions: no trigonometry. */
static inline struct cell_angles cell_angles_of(const double wi[3], const double wo[3])
{
	double x = wi[0] + wo[0], y = wi[1] + wo[1], z = wi[2] + wo[2];
	double inverse = 1 / sqrt(x * x + y * y + z * z);

	return (struct cell_angles){wi[2], wo[2], z * inverse, (wi[0] * x + wi[1] * y + wi[2] * z) * inverse};
}

/*
 * Lattice coordinates of a pair of directions: out[0] in [0, H), out[1] in [0, D), out[2] in [0, P),
 * in cells; truncating each gives the cell of the database's own sample code.
 */
void lattice_coordinates(struct lattice_dims dims, const double wi[3], const double wo[3], double out[3]);

/* Such a coordinate -> the cell whose centre is before it, and the fraction of the way to the next; 0 outside all centres. */
static inline uint32_t centre_before(double at, uint32_t extent, double *fraction)
{
	double from = fmin(fmax(at - 0.5, 0), extent - 1);
	uint32_t cell = (uint32_t)from;

	*fraction = from - cell;
	return cell;
}

#endif
