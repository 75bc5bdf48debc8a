/* fidelity_kernels.inc.h: the loops of fidelity_kernels.h, for the including file's target. KERNEL(name) must be defined. */
#include "fidelity_kernels.h"
#include "model/math/vector.h"

#include "fidelity.inc.h"

const struct fidelity_kernels KERNEL(fidelity_kernels) = {
	.fidelity_slice = KERNEL(fidelity_slice),
};
