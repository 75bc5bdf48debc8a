/* kernels.inc.h: all loops of kernels.h, for the target that the including file is compiled for. KERNEL(name) must be defined. */
#include "kernels.h"
#include "vector.h"

#include "density.inc.h"
#include "fidelity.inc.h"
#include "fill.inc.h"
#include "paper.inc.h"
#include "robust.inc.h"
#include "robust_anchor.inc.h"
#include "spectrum.inc.h"
#include "cosines.inc.h"
#include "spectrum_inverse.inc.h"
#include "default.inc.h"
#include "compact_row.inc.h"

const struct kernels KERNEL(kernels) = {
	.density_row = KERNEL(density_row),
	.fidelity_slice = KERNEL(fidelity_slice),
	.fill_halve = KERNEL(fill_halve),
	.fill_interpolate = KERNEL(fill_interpolate),
	.fill_smooth = KERNEL(fill_smooth),
	.paper_row = KERNEL(paper_row),
	.paper_colour = KERNEL(paper_colour),
	.robust_anchor = KERNEL(robust_anchor),
	.robust_scale = KERNEL(robust_scale),
	.robust_sums = KERNEL(robust_sums),
	.cosine_product = KERNEL(cosine_product),
	.cosine_fold = KERNEL(cosine_fold),
	.cosine_gather = KERNEL(cosine_gather),
	.cosine_join = KERNEL(cosine_join),
	.cosine_rotate = KERNEL(cosine_rotate),
	.cosine_scatter = KERNEL(cosine_scatter),
	.cdf97_forward = KERNEL(cdf97_forward),
	.cdf97_plane = KERNEL(cdf97_plane),
	.spectrum_spread = KERNEL(spectrum_spread),
	.compact_row = KERNEL(compact_row),
	.default_logs = KERNEL(default_logs),
	.default_largest = KERNEL(default_largest),
	.default_moments = KERNEL(default_moments),
	.default_values = KERNEL(default_values),
	.default_codes = KERNEL(default_codes),
	.default_rotate = KERNEL(default_rotate),
	.default_smooth = KERNEL(default_smooth),
	.default_shrink = KERNEL(default_shrink),
};
