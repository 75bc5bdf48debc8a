/* paper_kernels.inc.h: the loops of paper_kernels.h, for the including file's target. KERNEL(name) must be defined. */
#include "paper_kernels.h"
#include "model/math/vector.h"

#include "importance.inc.h"
#include "paper_rows.inc.h"
#include "solver.inc.h"
#include "wavelet.inc.h"

const struct paper_kernels KERNEL(paper_kernels) = {
	.wavelet_split = KERNEL(wavelet_split),
	.wavelet_join = KERNEL(wavelet_join),
	.mirror_split = KERNEL(mirror_split),
	.mirror_join = KERNEL(mirror_join),
	.residual = KERNEL(residual),
	.weigh = KERNEL(weigh),
	.add_scaled = KERNEL(add_scaled),
	.turn = KERNEL(turn),
	.gains = KERNEL(gains),
	.fit_row = KERNEL(fit_row),
	.fit_columns = KERNEL(fit_columns),
	.quotients = KERNEL(quotients),
	.importance_row = KERNEL(importance_row),
	.normalise_row = KERNEL(normalise_row),
	.paper_row = KERNEL(paper_row),
	.paper_colour = KERNEL(paper_colour),
};
