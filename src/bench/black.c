/* black.c: no model: every value 0. Whatever has less than its PSNR is worse than nothing. */
#include <stdlib.h>
#include <string.h>

#include "baseline.h"

static bp_status black_fit(const struct baseline *self, const struct bench_material *material, struct fitted *out,
                           bp_error *error)
{
	(void)self;
	(void)material;
	(void)error;
	*out = (struct fitted){0};
	return BP_OK;
}

static bp_status black_expand(const void *state, struct expansion *out, bp_error *error)
{
	(void)state;
	(void)error;
	out->unit = 1;
	for (int c = 0; c < 3; c++)
		memset(out->rgb[c], 0, lattice_cells(out->dims) * sizeof *out->rgb[c]);
	return BP_OK;
}

static void black_evaluate(const void *state, const double wi[3], const double wo[3], double rgb[3])
{
	(void)state;
	(void)wi;
	(void)wo;
	rgb[0] = rgb[1] = rgb[2] = 0;
}

const struct baseline BASELINE_BLACK = {
	.reference = "no light at all",
	.fit = black_fit,
	.expand = black_expand,
	.evaluate = black_evaluate,
	.free_state = free,
};
