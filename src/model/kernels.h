/*
 * kernels.h: the hot loops, compiled twice and chosen once.
 *
 * The loops stand in the files NAME.inc.h as static functions KERNEL(name). kernels.c includes them all for
 * any x86-64 (or other) processor, kernels_avx2.c the same text with AVX2; each ends in one table of
 * function pointers. To add a loop: write KERNEL(loop) in an .inc.h, include that in kernels.inc.h, add a
 * member here and an initialiser there.
 *
 * Both tables give the same bits: no fused multiply-add, no reassociation by the compiler, and sums run over
 * a fixed number of lanes (vector.h) whatever the machine's vectors are.
 */
#ifndef MODEL_KERNELS_H
#define MODEL_KERNELS_H

#include <stddef.h>
#include <stdint.h>

struct fidelity_sums {
	double log_squares;      /* of log2 ratios */
	double cube_root_squares;
	double largest_relative;
};

struct kernels {
	/*
	 * Adds the n cells of one channel of one theta_h slice to *sums: b measured, unit * e decoded, in 1/sr;
	 * cosine >= 0; cells with valid = 0 add nothing.
	 */
	void (*fidelity_slice)(const double *b, const float *e, const uint8_t *valid, const float *cosine, size_t n, double unit,
	                       struct fidelity_sums *sums);
};

/* The table for this processor. Thread-safe; never NULL. */
const struct kernels *kernels_get(void);

extern const struct kernels kernels_plain, kernels_avx2; /* kernels_avx2: only where kernels_avx2_usable() */
int kernels_avx2_usable(void);

#endif
