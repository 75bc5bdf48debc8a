/*
 * warped.h: a material as the fields of a tensor file of the RGL database (Dupuy and Jakob 2018), isotropic, in RGB.
 *
 * With u = sqrt(2 theta/pi), a half vector m at (u_m, v_m) is warped to (s, t) by the density of visible normals at theta_i
 * (visible.h, rgl/warp.h), and
 *
 *     f cos theta_o = rgb(theta_i; s, t) ndf(u_m)/(4 sigma(u_i))
 *
 * with all fields linear between their nodes. format-spec/RENDERERS.md has the file's layout and the sources.
 */
#ifndef TOOL_EXPORT_WARPED_H
#define TOOL_EXPORT_WARPED_H

#include "reflectance.h"
#include "visible.h"

/* Nodes along each axis. */
struct warped_shape {
	uint32_t angles;        /* theta_i, from 0 to pi/2 */
	uint32_t width, height; /* u_m and v_m of vndf */
	uint32_t size;          /* s and t of luminance and rgb: size x size */
	struct visible_mix mix; /* where the samples lie */
};
enum { WARPED_NORMALS = 181 }; /* u of ndf and sigma: those of MERL's lattice, its cells' edges and centres */

struct warped {
	struct warped_shape shape;
	struct normals normals;
	struct warp visible; /* [angles]: densities of mass 1 over the unit square */
	float *theta_i;      /* [angles], radians */
	float *luminance;    /* [angles][size][size]: the mean of rgb, but not below 1e-4 of its slice's mean; 1 in a black slice */
	float *rgb; /* [angles][3][size][size]; below 0 beyond the horizon alone, so that f cos theta_o passes through 0 on it */
};

/*
 * Evaluates the material at all nodes, and settles these (warped_settle). warped_free in any case. BP_ERROR_BAD_INPUT where a
 * value is beyond what a float holds.
 */
bp_status warped_make(const struct reflectance *reflectance, const struct warped_shape *shape, struct warped *out,
                      bp_error *error);
/*
 * A straight line between two points of a curve lies on one side of it; what readers interpolate is too bright where f is hollow.
 * Adds to each sample the mean of what is missing around it, at four points of each cell between samples, four times over,
 * weighted as the reader's interpolation weighs the sample: for a function of second degree that leaves a mean of 0.
 */
bp_status warped_settle(const struct reflectance *reflectance, struct warped *warped, bp_error *error);
void warped_free(struct warped *warped); /* a zeroed struct is allowed */

/* f cos theta_o as a reader of the file has it, in 1/sr; unit vectors; 0 where either is on or below the horizon. */
void warped_evaluate(const struct warped *warped, const float wi[3], const float wo[3], double rgb[3]);

#endif
