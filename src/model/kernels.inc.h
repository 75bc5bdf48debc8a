/* kernels.inc.h: all loops of kernels.h, for the target that the including file is compiled for. KERNEL(name) must be defined. */
#include "kernels.h"
#include "model/math/vector.h"

#include "model/paper/density.inc.h"
#include "fidelity.inc.h"
#include "model/math/fill_kernels.inc.h"
#include "model/paper/paper.inc.h"
#include "model/robust/robust_sums.inc.h"
#include "model/robust/robust_anchor.inc.h"
#include "model/spectral/spectrum.inc.h"
#include "model/spectral/cosines.inc.h"
#include "model/spectral/spectrum_inverse.inc.h"
#include "model/spectral/spectral_values.inc.h"
#include "model/table/compact_row.inc.h"

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
	.spectral_logs = KERNEL(spectral_logs),
	.spectral_largest = KERNEL(spectral_largest),
	.spectral_moments = KERNEL(spectral_moments),
	.spectral_values = KERNEL(spectral_values),
	.spectral_codes = KERNEL(spectral_codes),
	.spectral_rotate = KERNEL(spectral_rotate),
	.spectral_smooth = KERNEL(spectral_smooth),
	.spectral_shrink = KERNEL(spectral_shrink),
};
