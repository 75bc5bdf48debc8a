/*
 * visible.h: where a half vector m is likely to lie for a direction w, and the unit square stretched by that.
 *
 * For each of some angles theta_i a density over (u, v): u = sqrt(2 theta_m/pi), v = (phi_m - phi_i + pi)/(2 pi). The field `vndf` of
 * a tensor file. A point (u, v) is warped to (s, t): t is the share of the mass below v, s the share of the line at v that lies
 * before u (Dupuy and Jakob 2018, section 4). The density is bilinear between its nodes, and between two angles the mean of both by
 * weights, each of mass 1: so readers of the file look it up.
 *
 * Visible normals of a distribution D have the density D(m) <w, m>/sigma(w). A part of the mass follows the material's own D, a part
 * its square root, the rest a uniform one: lobes grow wider, or come to light, towards grazing angles, and the samples of
 * `rgb` must lie closely there too. What is drawn too often thereby, `luminance` sets right.
 */
#ifndef TOOL_EXPORT_VISIBLE_H
#define TOOL_EXPORT_VISIBLE_H

#include "normals.h"

/* Parts of the mass; what is left to 1 follows D. */
struct visible_mix {
	double soft, uniform;
};

struct visible {
	uint32_t angles, width, height;
	float *density; /* [angle][v][u], as it is written */
	double *lines;  /* [angle][v][u]: the integral of the line at v from 0 to u */
	double *below;  /* [angle][v]: the mass below v, 1 at the last */
};

/* theta_i[angles] ascending, width and height at least 2. The caller frees with visible_free. */
bp_status visible_make(const struct normals *normals, struct visible_mix mix, uint32_t angles, const float *theta_i,
                       uint32_t width, uint32_t height, struct visible *out, bp_error *error);
void visible_free(struct visible *visible); /* a zeroed struct is allowed */

/* (u, v) -> (s, t) by angles `angle` and `angle + 1`, the latter by `weight` in [0, 1] (0: alone; it need not be there). */
void visible_warp(const struct visible *visible, uint32_t angle, double weight, const double at[2], double out[2]);

/* wi at azimuth 0 -> wo, mirrored at the half vector (u, v). */
void visible_mirror(const double wi[3], const double at[2], double wo[3]);

/* (s, t) -> (u, v) by one angle: the other way round. */
void visible_unwarp(const struct visible *visible, uint32_t angle, const double at[2], double out[2]);

#endif
