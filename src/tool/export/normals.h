/*
 * normals.h: a distribution of microfacet normals that explains a material.
 *
 * In microfacet theory f(w, w) = F D(w)/(4 cos theta sigma(w)), as nothing hides a facet from the direction it faces, with the
 * projected area sigma(w) = the integral of D(m) <w, m> over the hemisphere of m, <,> cut at 0. So D is the eigenvector of the
 * largest eigenvalue of D -> f cos theta sigma(D), which power iteration finds (Dupuy, Heitz, Iehl, Poulin and Ostromoukhov 2015;
 * Dupuy and Jakob 2018). Isotropic: D and sigma depend on theta alone. They are given at nodes u = n/(count - 1) of
 * theta = u^2 pi/2 and are linear in u between these, as readers of tensor files have them.
 */
#ifndef TOOL_EXPORT_NORMALS_H
#define TOOL_EXPORT_NORMALS_H

#include <stdint.h>

#include "brdfpack.h"

struct normals {
	uint32_t count;
	double *density, *area;   /* D in 1/sr, the integral of D cos theta is 1, above 0 everywhere; sigma, 1 at u = 0 */
	double *soft, *soft_area; /* the same of D's square root: a wider distribution around the same peak */
};

/* profile[count]: f(w, w), or what stands for it, at the nodes: in any unit, 0 or more; all 0: a uniform D. normals_free *out. */
bp_status normals_make(uint32_t count, const double *profile, struct normals *out, bp_error *error);
void normals_free(struct normals *normals); /* a zeroed struct is allowed */

/* One of its four functions between the nodes: u in [0, 1]. */
double normals_at(const struct normals *normals, const double *values, double u);

/* Between u and an angle from the normal in radians. */
double normals_u(double theta);
double normals_theta(double u);

#endif
