/* The same loops as robust_kernels.c, compiled for AVX2 by the Makefile's rule for *_avx2.c. */
#define KERNEL(name) name##_avx2
#include "robust_kernels.inc.h"
