/*
 * ward.c: G. J. Ward, "Measuring and modeling anisotropic reflection", SIGGRAPH 1992, eq. 4 (isotropic):
 *
 *     lobe = exp(-tan^2 theta_h / alpha^2) / (4 pi alpha^2 sqrt(cos theta_i cos theta_o))
 *
 * 7 parameters: alpha, and diffuse and specular albedo per channel. 28 bytes.
 */
#include "lobe.h"

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

const struct baseline BASELINE_WARD = LOBE_BASELINE("Ward 1992, isotropic", LOBE_WARD, LOBE_COSINE);
const struct baseline BASELINE_WARD_RELATIVE = LOBE_BASELINE("Ward 1992, isotropic; relative error", LOBE_WARD, LOBE_RELATIVE);
