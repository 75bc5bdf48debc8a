/* paper_kernels.inc.h: all loops of paper_kernels.h, for the target that the including file is compiled for. KERNEL(name) must be defined. */
#include "paper_kernels.h"
#include "model/math/vector.h"

#include "density.inc.h"
#include "paper_rows.inc.h"

const struct paper_kernels KERNEL(paper_kernels) = {
	.density_row = KERNEL(density_row),
	.paper_row = KERNEL(paper_row),
	.paper_colour = KERNEL(paper_colour),
};
