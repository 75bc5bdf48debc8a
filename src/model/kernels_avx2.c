/* kernels_avx2.c: the same loops as kernels.c, compiled for AVX2 by the Makefile's rule for *_avx2.c. */
#define KERNEL(name) name##_avx2
#include "kernels.inc.h"
