/* paper_kernels.h: the rows of the density and of the model's product, compiled twice (math/kernels.h). */
#ifndef MODEL_PAPER_PAPER_KERNELS_H
#define MODEL_PAPER_PAPER_KERNELS_H

#include <stddef.h>
#include <stdint.h>

#include "model/math/kernels.h"

struct paper_kernels {
	/*
	 * value = factor (r + g + b) where valid, else 0, for the n cells of a row; adds them to column_sum and the valid
	 * ones to column_count; *count = the valid ones. Returns their sum, in four lanes.
	 */
	double (*density_row)(const double *const rgb[3], const uint8_t *valid, size_t n, double factor, double *value,
	                      double *column_sum, uint32_t *column_count, uint32_t *count);

	/* out = row column dphi (NULL: 1), of paper_expand.c; and rgb = max(0, diffuse + specular achromatic). */
	void (*paper_row)(float row, const float *column, const float *dphi, size_t n, float *out);
	void (*paper_colour)(const float *achromatic, size_t n, const float diffuse[3], const float specular[3], float limit,
	                     float *const rgb[3]);
};

extern const struct paper_kernels paper_kernels_plain, paper_kernels_avx2;

/* Those for this processor. */
static inline const struct paper_kernels *paper_kernels_get(void)
{
	return kernels_avx2_usable() ? &paper_kernels_avx2 : &paper_kernels_plain;
}

#endif
