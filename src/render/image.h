/*
 * image.h: linear images -> exposure -> sRGB.
 */
#ifndef RENDER_IMAGE_H
#define RENDER_IMAGE_H

#include <math.h>

#include "sphere.h"

/*
 * The factor that brings the reference's 90th percentile of the channel mean to 0.9: with the n covered
 * pixels' means (R + G + B)/3 in ascending order, 0.9 / max(1e-12, mean[floor(0.9 n)]), in 1/unit.
 */
bp_status image_exposure(const struct sphere_image *reference, double *exposure, bp_error *error);

/*
 * Value n of both images, exposed and brought to 0 .. 1 by `curve`: a of the reference, b of the estimate; one that is not finite
 * is as far off as can be, 1 - a.
 */
static inline void image_pair(const struct sphere_image *reference, const struct sphere_image *estimate, size_t n,
                              double exposure, double (*curve)(double linear), double *a, double *b)
{
	const double e = (double)estimate->rgb[n];
	*a = curve((double)reference->rgb[n] * exposure);
	*b = isfinite(e) ? curve(e * exposure) : 1 - *a;
}

double image_clamped(double linear); /* 0 .. 1 */

/* IEC 61966-2-1: linear, clamped to 0 .. 1, to the sRGB curve in 0 .. 1. */
double image_srgb(double linear);

#endif
