/* fidelity.inc.h: the sums of fidelity.h. See kernels.h. */
#include "fast_math.h"

enum { FIDELITY_BLOCK = 64 };

static void KERNEL(fidelity_slice)(const double *b, const float *e, const uint8_t *valid, const float *cosine, size_t n,
                                   double unit, struct fidelity_sums *sums)
{
	lanes4 log_squares = {0, 0, 0, 0}, cube_squares = {0, 0, 0, 0};
	double largest = sums->largest_relative;

	for (size_t start = 0; start < n; start += FIDELITY_BLOCK) {
		double dl[FIDELITY_BLOCK], dc[FIDELITY_BLOCK], root[FIDELITY_BLOCK];
		double bb[FIDELITY_BLOCK], ee[FIDELITY_BLOCK];
		size_t m = n - start < FIDELITY_BLOCK ? n - start : FIDELITY_BLOCK;
		unsigned any = 0;
		uint64_t larger = 0;

		for (size_t l = 0; l < m; l++)
			any |= valid[start + l];
		if (!any)
			continue;

		/* A cell that does not count becomes b = e = 0, whose differences are exactly 0. */
		for (size_t l = 0; l < m; l++) {
			double keep = valid[start + l] ? 1 : 0;
			bb[l] = b[start + l] * keep;
			ee[l] = unit * (double)e[start + l] * keep;
			root[l] = cosine[start + l];
		}
		for (size_t l = m; l < FIDELITY_BLOCK; l++)
			bb[l] = ee[l] = root[l] = 0;
		for (size_t l = 0; l < FIDELITY_BLOCK; l++) {
			dl[l] = fast_log2((ee[l] + 1e-3) / (bb[l] + 1e-3));
			double d = ee[l] - bb[l];
			larger |= (d < 0 ? -d : d) > largest * (bb[l] + 1e-2);
		}
		if (larger) /* seldom: the division is worth a branch */
			for (size_t l = 0; l < FIDELITY_BLOCK; l++) {
				double d = ee[l] - bb[l], relative = (d < 0 ? -d : d) / (bb[l] + 1e-2);
				largest = relative > largest ? relative : largest;
			}
		for (size_t l = 0; l < FIDELITY_BLOCK; l++)
			dc[l] = fast_cbrt(bb[l] * root[l]) - fast_cbrt(ee[l] * root[l]);
		for (size_t l = 0; l < FIDELITY_BLOCK; l += 4) {
			lanes4 x = LANES_LOAD(dl + l), y = LANES_LOAD(dc + l);
			log_squares += x * x;
			cube_squares += y * y;
		}
	}
	sums->log_squares += lanes_sum(&log_squares);
	sums->cube_root_squares += lanes_sum(&cube_squares);
	sums->largest_relative = largest;
}
