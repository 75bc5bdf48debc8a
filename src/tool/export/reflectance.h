/* reflectance.h: a material as a function of two directions, many pairs at once: what an exported file is sampled from. */
#ifndef TOOL_EXPORT_REFLECTANCE_H
#define TOOL_EXPORT_REFLECTANCE_H

#include <stdbool.h>
#include <stddef.h>

/*
 * f in 1/sr for `count` pairs of unit vectors in separate arrays of components, not negative; 0 where one is not above the
 * horizon: what table_evaluate_batch gives.
 */
struct reflectance {
	void (*evaluate)(const void *user, size_t count, const float *const wi[3], const float *const wo[3], float *const rgb[3]);
	const void *user;
};

/* Pairs of directions, and room for their values. */
struct pairs {
	size_t count;
	float *wi[3], *wo[3], *rgb[3];
};

bool pairs_alloc(size_t count, struct pairs *out); /* false: no memory; pairs_free in any case */
void pairs_free(struct pairs *pairs);              /* a zeroed struct is allowed */
void pairs_set(struct pairs *pairs, size_t n, const double wi[3], const double wo[3]);
void pairs_evaluate(struct pairs *pairs, const struct reflectance *reflectance);

/* The direction at angles theta and phi in radians. */
void direction_at(double theta, double phi, double w[3]);

#endif
