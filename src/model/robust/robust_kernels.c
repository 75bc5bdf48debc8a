/* The loops of robust_kernels.h for any processor. */
#define KERNEL(name) name##_plain
#include "robust_kernels.inc.h"
