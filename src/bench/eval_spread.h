/* eval_spread.h: the relative standard deviation of sampling weights, per material. */
#ifndef BENCH_EVAL_SPREAD_H
#define BENCH_EVAL_SPREAD_H

#include "brdfpack.h"

/*
 * Prints one row: name, mean deviation over angles by our sampling, cosine sampling and a fitted GGX lobe with cosine, the lobe's
 * roughness and share, the largest gap between the albedo and the mean weight. Adds the deviations to sums.
 */
void spread_print(const bp_archive *archive, uint64_t index, const char *name, double sums[3]);

#endif
