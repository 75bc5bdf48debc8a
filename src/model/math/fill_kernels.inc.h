/* fill_kernels.inc.h: the loops of fill_kernels.h, for the including file's target. KERNEL(name) must be defined. */
#include <string.h>

#include "fill_kernels.h"
#include "vector.h"

#include "fill_steps.inc.h"

const struct fill_kernels KERNEL(fill_kernels) = {
	.fill_halve = KERNEL(fill_halve),
	.fill_interpolate = KERNEL(fill_interpolate),
	.fill_smooth = KERNEL(fill_smooth),
};
