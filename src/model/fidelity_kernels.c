/* The loops of fidelity_kernels.h for any processor. */
#define KERNEL(name) name##_plain
#include "fidelity_kernels.inc.h"
