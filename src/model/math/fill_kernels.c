/* The loops of fill_kernels.h for any processor. */
#define KERNEL(name) name##_plain
#include "fill_kernels.inc.h"
