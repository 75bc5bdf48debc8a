/*
 * sample.h: importance sampling of f(wi, wo) cos theta_i for a given wo (the paper's eq. 8, made practical).
 *
 * For NODES angles theta_o (sampler.h), a density over the half-angle h in the frame where wo has azimuth 0:
 * piecewise constant in s = sin^2(theta_h / 2) and in |phi_h| (isotropic materials are nearly mirror-symmetric;
 * what little is not costs variance, never exactness). dw_h = 2 ds dphi and dw_i = 4 (wo.h) dw_h, so a bin's
 * mass is the sum of mean(R, G, B) cos theta_i 4 (wo.h) over it. Bins are as the lattice's: edge n at
 * s = (n/N)^4 / 2, which is theta_h = (n/N)^2 times nearly a right angle: dense at the highlight.
 *
 * wi lies above the horizon exactly where theta_h < pi/4 + atan(tan theta_o cos phi)/2 (from
 * wi.z = 2 (wo.h) h.z - wo.z). For the wo at hand, the conditional distribution of s given phi is cut there and
 * divided by what remains of it, so no sample is lost below the horizon, and the density integrates to 1
 * whatever wo. Between two nodes the density is their mixture, each cut at the actual horizon. A share of
 * cosine-distributed samples is mixed in, so the density is nowhere 0 above the horizon. Past 89.977 degrees wo counts
 * as being there: 4e-4 from the horizon, rounding moves the half-angle by as much as its range.
 */
#ifndef MODEL_SAMPLE_SAMPLE_H
#define MODEL_SAMPLE_SAMPLE_H

#include "albedo.h"

struct sampler; /* immutable once built: any number of threads may use it */

bp_status sampler_build(const struct table *table, struct sampler **out, bp_error *error);
void sampler_free(struct sampler *sampler); /* NULL is allowed */
size_t sampler_bytes(const struct sampler *sampler);

/*
 * Draws wi (unit length, above the horizon) for wo and three independent uniform numbers in [0, 1), and returns its
 * density per solid angle: what sampler_pdf returns for the same pair, > 0 and finite. Numbers outside [0, 1) are clamped, NaN is
 * 0. Returns 0, with wi = 0, where wo is below or on the horizon, zero, infinite or NaN.
 */
float sampler_draw(const struct sampler *sampler, const float wo[3], const float u[3], float wi[3]);
/* The density of wi given wo; 0 where either is unusable (see table.h). */
float sampler_pdf(const struct sampler *sampler, const float wi[3], const float wo[3]);

#endif
