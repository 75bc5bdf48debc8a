/*
 * sphere_error.h: how far an exported file is from its material: PSNR of a sphere under the point lights and under the key lights,
 * the smaller of both, as `brdfpack compare` defines it (render/metrics.h). Seen along -z, with w_i towards the viewer.
 */
#ifndef TOOL_EXPORT_SPHERE_ERROR_H
#define TOOL_EXPORT_SPHERE_ERROR_H

#include "reflectance.h"

#include "brdfpack.h"

/* f cos theta_o of an exported file, by its own look-up. */
typedef void exported_evaluate(const void *exported, const float wi[3], const float wo[3], double rgb[3]);

/* The pairs that the sphere shows, and the material's image: made once for a material. */
struct sphere_reference;
bp_status sphere_reference_make(const struct reflectance *reflectance, struct sphere_reference **out, bp_error *error);
void sphere_reference_free(struct sphere_reference *reference); /* NULL is allowed */

bp_status sphere_error(const struct sphere_reference *reference, exported_evaluate *evaluate, const void *exported, double *psnr,
                       bp_error *error);

#endif
