/*
 * upsampling.h: linear RGB -> a smooth spectrum, for readers of tensor files that know no `rgb`.
 *
 * A spectrum is R r(l) + G g(l) + B b(l): linear in RGB, so that what is interpolated between samples stays what it was. The
 * three functions are not negative, at most 1, sum to 1 everywhere (white and grey are flat), and under illuminant D65 the CIE
 * 1931 observer sees each as its primary of sRGB (ITU-R BT.709). Of all such functions they are the smoothest: the sum of squared
 * second differences is least. Values below 0 (beyond the horizon) pass through as they are.
 */
#ifndef TOOL_EXPORT_UPSAMPLING_H
#define TOOL_EXPORT_UPSAMPLING_H

#include <stddef.h>

enum { UPSAMPLING_COUNT = 16 };
extern const float UPSAMPLING_WAVELENGTHS[UPSAMPLING_COUNT]; /* nm, ascending, equally spaced; linear between them */

/* rgb[slices][3][points] -> spectra[slices][UPSAMPLING_COUNT][points] */
void upsample(const float *rgb, size_t slices, size_t points, float *spectra);

#endif
