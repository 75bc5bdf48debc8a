/*
 * lattice_horizon.c: the lattice's cosines, and from them what lies below the horizon.
 */
#include <math.h>
#include <string.h>

#include "lattice.h"

void quarter_cos_sin(double t, double *cosine, double *sine)
{
	/* Taylor series on [0, pi/4]: the first term left out is below 1e-18. */
	static const double SINE[] = {-1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
	                              -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
	static const double COSINE[] = {-0.5,           1.0 / 24,        -1.0 / 720,         1.0 / 40320,
	                                -1.0 / 3628800, 1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000};
	const double x = (t <= 0.5 ? t : 1 - t) * 1.57079632679489661923, y = x * x;
	double s = 0, c = 0;
	for (int n = 8; n-- > 0;) {
		s = SINE[n] + y * s;
		c = COSINE[n] + y * c;
	}
	s = x + x * y * s;
	c = 1 + y * c;
	*cosine = t <= 0.5 ? c : s;
	*sine = t <= 0.5 ? s : c;
}

/*
 * The database's pattern was computed with pi = 3.1416: centres with that pi give it back to the
 * cell, with an exact pi 6 of its 305,826 invalid cells would be taken for holes above the limit.
 */
static const double CENTRE_SCALE = 3.1416 / 3.14159265358979323846;

/* |cos(scale pi x / extent)|, 0 <= x <= extent; the same for x and extent - x */
static double phi_cosine(double x, double extent, double scale)
{
	const double t = scale * (2 * x <= extent ? 2 * x / extent : 2 * (extent - x) / extent);
	double cosine, sine;
	quarter_cos_sin(t <= 1 ? t : 1, &cosine, &sine);
	return cosine;
}

/* At cell + offset, |cos| along phi_d, angles times `scale`: 0 and 1 for the lower corner, 0.5 and CENTRE_SCALE the centre. */
static void cosines_fill(struct lattice_dims dims, double offset, double scale, struct lattice_cosines *out)
{
	for (uint32_t i = 0; i < dims.theta_h; i++) {
		const double root = (i + offset) / dims.theta_h;
		quarter_cos_sin(scale * root * root, &out->cos_h[i], &out->sin_h[i]);
	}
	for (uint32_t j = 0; j < dims.theta_d; j++)
		quarter_cos_sin(scale * (j + offset) / dims.theta_d, &out->cos_d[j], &out->sin_d[j]);
	for (uint32_t k = 0; k < dims.phi_d; k++)
		out->cos_p[k] = phi_cosine(k + offset, dims.phi_d, scale);
}

void lattice_centres(struct lattice_dims dims, struct lattice_cosines *out)
{
	double cosine, sine;
	cosines_fill(dims, 0.5, 1, out);
	for (uint32_t k = 0; k < dims.phi_d; k++) {
		const double t = (2.0 * k + 1) / dims.phi_d;
		quarter_cos_sin(t <= 1 ? t : 2 - t, &cosine, &sine);
		out->cos_p[k] = t <= 1 ? cosine : -cosine;
	}
}

void lattice_highest(struct lattice_dims dims, struct lattice_cosines *out)
{
	cosines_fill(dims, 0, 1, out);
	for (uint32_t k = 0; k < dims.phi_d; k++) {
		const bool crosses = 2 * k <= dims.phi_d && 2 * (k + 1) >= dims.phi_d; /* phi_d = pi/2 */
		out->cos_p[k] = crosses ? 0 : fmin(out->cos_p[k], phi_cosine(k + 1, dims.phi_d, 1));
	}
}

double lattice_lowest_below(struct lattice_dims dims, const uint8_t *mask)
{
	struct lattice_cosines highest, centre;
	lattice_highest(dims, &highest);
	cosines_fill(dims, 0.5, CENTRE_SCALE, &centre);
	double lowest = 0;
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++, mask += dims.phi_d) {
			const double a = centre.cos_d[j] * centre.cos_h[i], q = centre.sin_d[j] * centre.sin_h[i];
			const double high_a = highest.cos_d[j] * highest.cos_h[i], high_q = highest.sin_d[j] * highest.sin_h[i];
			if (a - q >= lowest)
				continue;
			for (uint32_t k = 0; k < dims.phi_d; k++) {
				const double cosine = a - q * centre.cos_p[k];
				if (mask[k] && cosine < lowest && high_a - high_q * highest.cos_p[k] <= 0)
					lowest = cosine;
			}
		}
	return lowest;
}

double lattice_horizon_limit(const struct lattice *lattice)
{
	const double lowest = lattice_lowest_below(lattice->dims, lattice->valid);
	if (lowest >= 0)
		return 0;
	/* Down by up to two float steps (7e-9): no rounding of a later computation takes a cell across. */
	return (double)nextafterf((float)(lowest > LATTICE_DEEPEST_HORIZON ? lowest : LATTICE_DEEPEST_HORIZON), -1);
}

/* 1: the smaller cosine at the centre is below the limit; highest: and all the cell below the horizon; NULL: anywhere. */
static void below_fill(struct lattice_dims dims, double limit, const struct lattice_cosines *highest, uint8_t *below)
{
	struct lattice_cosines centre;
	cosines_fill(dims, 0.5, CENTRE_SCALE, &centre);
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++, below += dims.phi_d) {
			const double a = centre.cos_d[j] * centre.cos_h[i], q = centre.sin_d[j] * centre.sin_h[i];
			for (uint32_t k = 0; k < dims.phi_d; k++)
				below[k] = a - q * centre.cos_p[k] < limit;
			if (!highest)
				continue;
			const double high_a = highest->cos_d[j] * highest->cos_h[i], high_q = highest->sin_d[j] * highest->sin_h[i];
			for (uint32_t k = 0; k < dims.phi_d; k++)
				below[k] &= high_a - high_q * highest->cos_p[k] <= 0;
		}
}

void lattice_below_horizon(struct lattice_dims dims, double limit, uint8_t *below)
{
	struct lattice_cosines highest;
	lattice_highest(dims, &highest);
	below_fill(dims, limit, &highest, below);
}

void lattice_centre_below(struct lattice_dims dims, double limit, uint8_t *below) { below_fill(dims, limit, NULL, below); }

void lattice_seen(struct lattice_dims dims, uint8_t *seen)
{
	struct lattice_cosines highest;
	lattice_highest(dims, &highest);
	double least = 1, most = 0;
	for (uint32_t k = 0; k < dims.phi_d; k++) {
		least = fmin(least, highest.cos_p[k]);
		most = fmax(most, highest.cos_p[k]);
	}
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++, seen += dims.phi_d) {
			const double a = highest.cos_d[j] * highest.cos_h[i], q = highest.sin_d[j] * highest.sin_h[i];
			/* Rounding keeps order, so the extremes tell of most rows as a whole. */
			if (a - q * most > 0 || !(a - q * least > 0)) {
				memset(seen, a - q * most > 0, dims.phi_d);
				continue;
			}
			for (uint32_t k = 0; k < dims.phi_d; k++)
				seen[k] = a - q * highest.cos_p[k] > 0;
		}
}

void lattice_corner_cosines(struct lattice_dims dims, uint32_t theta_h, float *cosine)
{
	struct lattice_cosines corner;
	cosines_fill(dims, 0, 1, &corner);
	for (uint32_t j = 0; j < dims.theta_d; j++, cosine += dims.phi_d) {
		const double a = corner.cos_d[j] * corner.cos_h[theta_h], q = corner.sin_d[j] * corner.sin_h[theta_h];
		for (uint32_t k = 0; k < dims.phi_d; k++) {
			const double smaller = a - q * corner.cos_p[k];
			cosine[k] = (float)(smaller > 0 ? smaller : 0);
		}
	}
}
