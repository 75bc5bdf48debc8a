/*
 * edwards.c: D. Edwards, S. Boulos, J. Johnson, P. Shirley, M. Ashikhmin, M. Stark, C. Wyman, "The halfway vector
 * disk for BRDF modeling", ACM Transactions on Graphics 25(1), 2006: the second model, for fitting data.
 *
 * A radial density ("lump") on the disk of halfway vectors,
 *
 *     p(u) = (n + 1) / (pi R^2) (1 - u^2 / R^2)^n          u < R <= 1, 0 beyond; its integral over the disk is 1
 *
 * As the second model gives up energy conservation, the disk is the orthographic one, u = sin theta_h, which
 * makes it reciprocal. Density on the disk -> density of h (cos theta_h) -> density of the other direction
 * (1 / (4 cos theta_d)) -> BRDF; the last cosine is made symmetric by taking the larger one:
 *
 *     lobe = F p(sin theta_h) cos theta_h / (4 cos theta_d max(cos theta_i, cos theta_o))
 *     F = f0 + (1 - f0) (1 - cos theta_d)^5                (Schlick)
 *
 * The article's text was not at hand: the lump, the disk and the Jacobians are the published ones, the choice of
 * one lump, of F and of the symmetric cosine are ours and generous (3 shape parameters).
 * 9 parameters: n, R, f0, and diffuse and specular albedo per channel. 36 bytes.
 */
#include "lobe.h"

static double edwards_value(const double *shape, struct cell_angles a)
{
	double n = shape[0], r2 = shape[1] * shape[1], inside = 1 - (1 - a.cos_h * a.cos_h) / r2, q = 1 - a.cos_d;
	double f = shape[2] + (1 - shape[2]) * q * q * q * q * q;

	if (!(inside > 0))
		return 0;
	return f * (n + 1) / (M_PI * r2) * pow(inside, n) * a.cos_h / (4 * a.cos_d * fmax(a.cos_i, a.cos_o));
}

const struct lobe_model LOBE_EDWARDS = {
	.shape_count = 3,
	.axis = {{LOBE_EXP, 0.5, 60000, 24}, {LOBE_UNIT, 0.15, 0.98, 4}, {LOBE_UNIT, 0.02, 0.8, 3}},
	.value = edwards_value,
};

const struct baseline BASELINE_EDWARDS = LOBE_BASELINE("Edwards et al. 2006, data-fitting model", LOBE_EDWARDS, LOBE_COSINE);
const struct baseline BASELINE_EDWARDS_RELATIVE =
	LOBE_BASELINE("Edwards et al. 2006, data-fitting model; relative error", LOBE_EDWARDS, LOBE_RELATIVE);
