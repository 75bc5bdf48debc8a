/*
 * itp.h: the colour difference of two images as people see it: dE ITP of Recommendation ITU-R BT.2124 (2019).
 *
 * Of the measures tried on pictures of approximated measured materials it agreed best with what people saw (Kavoosighafi
 * et al. 2025, "Perceived quality of BRDF models"). 1 is a just noticeable difference, to an eye adapted to just that colour.
 *
 * Colour is light in cd/m^2 of a display whose white is 100 (the reference white of television without high dynamic
 * range), R, G, B with the primaries of BT.709, which are sRGB's; the measured R, G, B are taken for these, as in image.h.
 * BT.2087 brings them to those of BT.2020:
 *
 *     R' = 0.6274 R + 0.3293 G + 0.0433 B      L = (1688 R' + 2146 G' + 262 B')/4096
 *     G' = 0.0691 R + 0.9195 G + 0.0114 B      M = (683 R' + 2951 G' + 462 B')/4096
 *     B' = 0.0164 R + 0.0880 G + 0.8956 B      S = (99 R' + 309 G' + 3688 B')/4096
 *
 *     q(F) = ((c1 + c2 y)/(1 + c3 y))^m2, y = (F/10000)^m1              the perceptual quantizer of BT.2100
 *     m1 = 2610/16384, m2 = 2523/32, c1 = 3424/4096, c2 = 2413/128, c3 = 2392/128
 *
 *     I = (q(L) + q(M))/2
 *     T = (6610 q(L) - 13613 q(M) + 7003 q(S))/8192                     half of BT.2100's C_T
 *     P = (17933 q(L) - 17390 q(M) - 543 q(S))/4096
 *
 *     dE = 720 sqrt(dI^2 + dT^2 + dP^2)
 *
 * By hand: every row above sums to 1 (T's and P's to 0), so white and half of it differ in I alone, by q(100) - q(50).
 * y(100) = 0.01^m1 = 0.48017, q(100) = (9.88792/9.97321)^78.84375 = 0.50808; y(50) = 0.005^m1 = 0.42997,
 * q(50) = (8.94161/9.03513)^78.84375 = 0.44028; dE = 720 x 0.06780 = 48.81.
 */
#ifndef RENDER_ITP_H
#define RENDER_ITP_H

#include "image.h"

/* Linear R, G, B in 0 .. 1, white being 1 -> I, T, P. */
void itp_of(const double rgb[3], double itp[3]);

double itp_difference(const double a[3], const double b[3]);

/*
 * The mean dE over covered pixels of two images of one size and unit, both exposed by the reference's exposure and
 * clamped to 0 .. 1, as metrics_psnr shows them but without rounding. A value of the estimate that is not finite
 * counts as 1 - a. 0 where no pixel is covered.
 */
bp_status itp_mean(const struct sphere_image *reference, const struct sphere_image *estimate, double *out, bp_error *error);

#endif
