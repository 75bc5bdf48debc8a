/* The loops of paper_kernels.h for any processor. */
#define KERNEL(name) name##_plain
#include "paper_kernels.inc.h"
