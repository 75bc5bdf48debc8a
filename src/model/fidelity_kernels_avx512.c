/* The same loops as fidelity_kernels.c, compiled for AVX-512 by the Makefile's rule for *_avx512.c. */
#define KERNEL(name) name##_avx512
#include "fidelity_kernels.inc.h"
