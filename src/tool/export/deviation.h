/*
 * deviation.h: how far an exported file is from its material.
 *
 * PSNR of a sphere under the point lights and under the key lights, the smaller of both, as `brdfpack compare` defines it
 * (render/metrics.h), seen along -z with w_i towards the viewer; and the directional albedo, by one quadrature for both.
 */
#ifndef TOOL_EXPORT_DEVIATION_H
#define TOOL_EXPORT_DEVIATION_H

#include <math.h>

#include "reflectance.h"

#include "brdfpack.h"

struct deviation {
	double psnr;   /* dB */
	double albedo; /* the largest relative difference in a channel at 6, 46 and 74 degrees */
};

#define DEVIATION_WORST ((struct deviation){-HUGE_VAL, HUGE_VAL})

/* Whether a file need not be larger: at least 52 dB, and albedos within half a per cent. */
bool deviation_suffices(const struct deviation *deviation);

/* f cos theta_o of an exported file, by its own look-up. */
typedef void exported_evaluate(const void *exported, const float wi[3], const float wo[3], double rgb[3]);

/* The pairs of directions, and what the material gives for them: made once for a material. */
struct deviation_reference;
bp_status deviation_reference_make(const struct reflectance *reflectance, struct deviation_reference **out, bp_error *error);
void deviation_reference_free(struct deviation_reference *reference); /* NULL is allowed */

bp_status deviation_measure(const struct deviation_reference *reference, exported_evaluate *evaluate, const void *exported,
                            struct deviation *out, bp_error *error);

#endif
