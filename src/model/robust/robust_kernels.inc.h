/* robust_kernels.inc.h: the loops of robust_kernels.h, for the including file's target. KERNEL(name) must be defined. */
#include "robust_kernels.h"
#include "model/math/vector.h"

#include "robust_sums.inc.h"
#include "robust_anchor.inc.h"

const struct robust_kernels KERNEL(robust_kernels) = {
	.robust_scale = KERNEL(robust_scale),
	.robust_sums = KERNEL(robust_sums),
	.robust_anchor = KERNEL(robust_anchor),
};
