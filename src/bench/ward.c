/*
 * ward.c: G. J. Ward, "Measuring and modeling anisotropic reflection", SIGGRAPH 1992, eq. 4 (isotropic):
 *
 *     lobe = exp(-tan^2 theta_h / alpha^2) / (4 pi alpha^2 sqrt(cos theta_i cos theta_o))
 *
 * 7 parameters: alpha, and diffuse and specular albedo per channel. 28 bytes.
 */
#include "lobe.h"

#include <stdlib.h>

static double ward_value(const double *shape, struct cell_angles a)
{
	double alpha2 = shape[0] * shape[0], tan2 = 1 / (a.cos_h * a.cos_h) - 1;

	return exp(-tan2 / alpha2) / (4 * M_PI * alpha2 * sqrt(a.cos_i * a.cos_o));
}

const struct lobe_model LOBE_WARD = {
	.shape_count = 1,
	.axis = {{LOBE_EXP, 0.003, 1.5, 24}},
	.value = ward_value,
};

static bp_status ward_fit(const struct bench_material *material, size_t budget_bytes, void **state, bp_error *error)
{
	(void)budget_bytes;
	return lobe_fit(&LOBE_WARD, material->lattice, LOBE_COSINE, state, error);
}

static bp_status ward_fit_relative(const struct bench_material *material, size_t budget_bytes, void **state, bp_error *error)
{
	(void)budget_bytes;
	return lobe_fit(&LOBE_WARD, material->lattice, LOBE_RELATIVE, state, error);
}

const struct baseline BASELINE_WARD = {
	.name = "ward",
	.reference = "Ward 1992, isotropic",
	.fit = ward_fit,
	.bytes = lobe_bytes,
	.parameters = lobe_parameters,
	.expand = lobe_expand,
	.evaluate = lobe_evaluate,
	.free_state = free,
};

const struct baseline BASELINE_WARD_RELATIVE = {
	.name = "ward-relative",
	.reference = "Ward 1992, isotropic; relative error",
	.fit = ward_fit_relative,
	.bytes = lobe_bytes,
	.parameters = lobe_parameters,
	.expand = lobe_expand,
	.evaluate = lobe_evaluate,
	.free_state = free,
};
