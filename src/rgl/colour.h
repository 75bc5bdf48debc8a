/*
 * colour.h: reflectance at wavelengths -> linear RGB.
 *
 * Observer: CIE 1931, 2 degrees. Illuminant: D65. Primaries: ITU-R BT.709 (sRGB's), white (1, 1, 1) for what reflects all light:
 *
 *     X = k sum over l of r(l) S(l) x(l), likewise Y and Z, k so that Y = 1 for r = 1;   RGB = M XYZ
 *
 * over l from 380 to 780 nm by 5, r linear between the given wavelengths and constant beyond them. RGB is linear in r, so it is
 * three weights to each wavelength. M is made from the primaries' chromaticities and the white of these very sums.
 */
#ifndef RGL_COLOUR_H
#define RGL_COLOUR_H

#include <stddef.h>

/*
 * weights[3 n + c] of n ascending wavelengths (nm): channel c = sum of weights[3 n + c] r[n]. The three sums of all weights are
 * 1. Channels of saturated colours may come out negative.
 */
void colour_weights(const double *wavelengths, size_t count, double *weights);

#endif
