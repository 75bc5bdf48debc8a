/* The loops of spectral_kernels.h for any processor. */
#define KERNEL(name) name##_plain
#include "spectral_kernels.inc.h"
