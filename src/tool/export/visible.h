/*
 * visible.h: where a half vector m is likely to lie for a direction w: the field `vndf` of a tensor file.
 *
 * For each of some angles theta_i a density over (u, v): u = sqrt(2 theta_m/pi), v = (phi_m - phi_i + pi)/(2 pi), of mass 1.
 * rgl/warp.h has the warp by it.
 *
 * Visible normals of a distribution D have the density D(m) <w, m>/sigma(w). A part of the mass follows the material's own D, a
 * part its square root, the rest a uniform one: lobes grow wider, or come to light, towards grazing angles, and the samples of
 * `rgb` must lie closely there too. What is drawn too often thereby, `luminance` sets right.
 */
#ifndef TOOL_EXPORT_VISIBLE_H
#define TOOL_EXPORT_VISIBLE_H

#include "normals.h"
#include "rgl/warp.h"

/* Parts of the mass; what is left to 1 follows D. */
struct visible_mix {
	double soft, uniform;
};

/*
 * theta_i[angles] ascending, radians, up to pi/2; width nodes of u and height of v, at least 2 each. The caller frees with
 * warp_free, after errors too. BP_ERROR_BAD_INPUT where the density at an angle is none.
 */
bp_status visible_make(const struct normals *normals, struct visible_mix mix, size_t angles, const float *theta_i, size_t width,
                       size_t height, struct warp *out, bp_error *error);

/* wi at azimuth 0 -> wo, mirrored at the half vector (u, v). */
void visible_mirror(const double wi[3], const double at[2], double wo[3]);

#endif
