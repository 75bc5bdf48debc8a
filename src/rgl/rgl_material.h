/*
 * rgl_material.h: a measured material of the RGL database, as its file describes it: a function of two directions.
 *
 * Fields of the file (T angles of incidence, of azimuths at most 2, of which the first is taken; all floats but the last two):
 *
 *     phi_i [1 or 2], theta_i [T]     radians, ascending. More azimuths: the material is anisotropic
 *     ndf [h][w], sigma [h'][w']      density of normals; its projected area, by direction of incidence
 *     vndf [1][T][H][W]               density of visible normals, whose warp the samples follow
 *     rgb [1][T][3][N][M]             f cos theta_o, without the factor below; or
 *     spectra [1][T][L][N][M] and wavelengths [L] (nm): the same by wavelength; they become linear RGB (colour.h)
 *     luminance [1][T][N][M]          not needed here; its shape is checked
 *     jacobian uint8 [1]              1: the factor applies
 *     valid uint8 [T N M / 8]         a bit for each sample, the highest first
 *
 * With u = (sqrt(2 theta / pi), (phi + pi) / 2 pi), u_m that of the half vector with phi_m - phi_i for azimuth (modulo 1), and
 * s = vndf's warp of u_m at theta_i,
 *
 *     f(wi, wo) cos theta_o = rgb(s, theta_i) ndf(u_m) / (4 sigma(u_i))
 *
 * all bilinear, theta_i linear; a channel below 0 counts as 0. Sources: Dupuy and Jakob, An Adaptive Parameterization for
 * Efficient Material Acquisition and Rendering (2018); rgl-epfl/brdf-loader.
 *
 * `valid`: in some published files the bits are the other way round. Most samples of a file are measured, so the rarer value is
 * the one that says "not measured"; and since such samples may hold values that were extrapolated well, only those that
 * are 0 in all channels are without data.
 */
#ifndef RGL_RGL_MATERIAL_H
#define RGL_RGL_MATERIAL_H

#include <stdbool.h>

#include "tensor_file.h"
#include "warp.h"

/* A function over the unit square, bilinear between nodes. */
struct rgl_grid {
	size_t height, width;
	float *values;
};

struct rgl_material {
	size_t angles;   /* T */
	double *theta_i; /* [T], radians, ascending */
	struct rgl_grid ndf, sigma;
	struct warp vndf;
	size_t height, width; /* of the samples */
	float *samples;       /* [T][height][width][4]: red, green, blue; 1 where there is data, 0 where not */
	bool jacobian;
	bool measured;        /* the file says which samples were measured: it comes from an instrument */
	uint32_t wavelengths; /* 0: an RGB file */
	double first, last;   /* nm, where there are wavelengths */
};

/* By the shapes alone, before more is read. BP_ERROR_BAD_INPUT, with the reason, where it is no isotropic material's table. */
bp_status rgl_table_check(const struct tensor_table *table, bp_error *error);

/*
 * The whole file, file_bytes of it, whose table was parsed with that size -> material. Errors name the field. It takes at most
 * 12 times the file's bytes while it runs. On success the caller frees with rgl_material_free.
 */
bp_status rgl_material_make(const uint8_t *file, const struct tensor_table *table, struct rgl_material *out, bp_error *error);
void rgl_material_free(struct rgl_material *material); /* a zeroed struct is allowed */

struct rgl_value {
	double rgb[3]; /* 1/sr, not below 0 */
	double data;   /* weight of the samples with data, 0 to 1 */
};

/*
 * f for light from (theta_i, phi_i), radians, phi_i from -pi to pi, which leaves at cos_o > 0; the half vector is at theta_m,
 * azimuth 0. Beyond the first and last theta_i the nearest one's values stay. Where sigma is 0, nothing is known: data 0.
 */
void rgl_evaluate(const struct rgl_material *material, double theta_i, double phi_i, double theta_m, double cos_o,
                  struct rgl_value *out);

/* Samples along theta_m, on their own grid, between two half angles at theta_i: above 1 their lobe is narrower than that. */
double rgl_samples_between(const struct rgl_material *material, size_t angle, double theta_m0, double theta_m1);

#endif
