/* The tables of loops of the spectral wing, to hold beside each other. */
#ifndef SPECTRAL_TABLES_H
#define SPECTRAL_TABLES_H

#include "model/spectral/spectral_kernels.h"

enum { SPECTRAL_TABLES = 3 };

/* Plain, for AVX2, for AVX-512; the plain one for what this processor does not have. */
static inline const struct spectral_kernels *spectral_table(int n)
{
	return n == 2 && kernels_avx512_usable() ? &spectral_kernels_avx512
	       : n == 1 && kernels_avx2_usable() ? &spectral_kernels_avx2
	                                         : &spectral_kernels_plain;
}

#endif
