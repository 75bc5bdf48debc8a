/*
 * cosines.h: the cosine transform of spectrum.h along phi_d, for many rows at once.
 *
 * Unscaled DCT-II and DCT-IV of n values, X_m = sum over k of x_k cos(pi m (k + 1/2) / n) and the same with m + 1/2:
 *
 *     II(n), even harmonics: II(n/2) of x_k + x_{n-1-k}; odd ones: IV(n/2) of x_k - x_{n-1-k}
 *     IV(n): rotate (x_k, x_{n-1-k}) by f_k = pi (2 k + 1) / 4 n to (a_k, b_k); A = II(n/2) of a, B = II(n/2) of (-1)^k b;
 *            X_0 = A_0, X_{2p} and X_{2p-1} = A_p + and - B_{n/2-p}, X_{n-1} = -B_0
 *
 * (Wang 1984; Britanak, Yip and Rao 2007) until n is odd or small; what is left are products with cosine tables, which are fast.
 * 180 values take 5,064 multiplications in products instead of the 16,200 of II(180) folded once.
 */
#ifndef MODEL_SPECTRAL_COSINES_H
#define MODEL_SPECTRAL_COSINES_H

#include <stddef.h>

#include "brdfpack.h"

/* cos(pi a / (2 P)), exact where it is 0, 1 or -1, and the same on every machine. */
double cosines_exact(uint64_t a, uint32_t p);

struct cosines; /* tables and scratch; one thread at a time */

bp_status cosines_create(uint32_t n, struct cosines **out, bp_error *error);
void cosines_free(struct cosines *cosines); /* NULL is allowed */

/*
 * Each of `count` rows of n values, in place: s_m X_m of x - base, s_0 = sqrt(1/n), s_m = sqrt(2/n); even harmonics first, then
 * the odd ones (spectrum_lane).
 */
void cosines_forward(struct cosines *cosines, float *rows, size_t count, float base);

#endif
