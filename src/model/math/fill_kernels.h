/* fill_kernels.h: the steps of fill.h on one level of its pyramid, compiled twice (math/kernels.h). */
#ifndef MODEL_MATH_FILL_KERNELS_H
#define MODEL_MATH_FILL_KERNELS_H

#include <stddef.h>
#include <stdint.h>

#include "kernels.h"

/* One level of the pyramid of fill.h. */
struct fill_level {
	uint32_t rows, columns;
	float *value;
	uint8_t *valid;
};

struct fill_kernels {
	/* The steps of fill.h; scratch holds two rows and four cells. */
	size_t (*fill_halve)(const struct fill_level *fine, const struct fill_level *coarse);
	void (*fill_interpolate)(const struct fill_level *coarse, const struct fill_level *fine, float *scratch);
	void (*fill_smooth)(const struct fill_level *level, unsigned sweeps, float *scratch);
};

KERNELS_OF(fill)

#endif
