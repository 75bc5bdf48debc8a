/* kernels.inc.h: all loops of kernels.h, for the target that the including file is compiled for. KERNEL(name) must be defined. */
#include "kernels.h"
#include "vector.h"

#include "fidelity.inc.h"

const struct kernels KERNEL(kernels) = {
	.fidelity_slice = KERNEL(fidelity_slice),
};
