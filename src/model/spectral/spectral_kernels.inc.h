/* spectral_kernels.inc.h: the loops of spectral_kernels.h, for the including file's target. KERNEL(name) must be defined. */
#include "spectral_kernels.h"
#include "model/math/vector.h"

#include "spectrum.inc.h"
#include "cosines.inc.h"
#include "spectrum_inverse.inc.h"
#include "spectral_values.inc.h"

const struct spectral_kernels KERNEL(spectral_kernels) = {
	.cosine_product = KERNEL(cosine_product),
	.span_unfold = KERNEL(span_unfold),
	.cosine_fold = KERNEL(cosine_fold),
	.cosine_rotate = KERNEL(cosine_rotate),
	.cosine_join = KERNEL(cosine_join),
	.cosine_gather = KERNEL(cosine_gather),
	.cosine_scatter = KERNEL(cosine_scatter),
	.cdf97_forward = KERNEL(cdf97_forward),
	.cdf97_plane = KERNEL(cdf97_plane),
	.spectral_logs = KERNEL(spectral_logs),
	.spectral_moments = KERNEL(spectral_moments),
	.spectral_values = KERNEL(spectral_values),
	.spectral_codes = KERNEL(spectral_codes),
	.spectral_rotate = KERNEL(spectral_rotate),
	.spectral_smooth = KERNEL(spectral_smooth),
	.spectral_shrink = KERNEL(spectral_shrink),
	.spectral_log2s = KERNEL(spectral_log2s),
	.spectral_worths = KERNEL(spectral_worths),
};
