/*
 * cook_torrance.c: R. L. Cook, K. E. Torrance, "A reflectance model for computer graphics", SIGGRAPH 1981:
 *
 *     lobe = F D G / (pi cos theta_i cos theta_o)
 *     D = exp(-tan^2 theta_h / m^2) / (m^2 cos^4 theta_h)                            (Beckmann)
 *     G = min(1, 2 cos theta_h cos theta_o / cos theta_d, 2 cos theta_h cos theta_i / cos theta_d)
 *     F = (g - c)^2 / (2 (g + c)^2) (1 + (c (g + c) - 1)^2 / (c (g - c) + 1)^2)      c = cos theta_d,
 *         g^2 = n^2 + c^2 - 1, n = (1 + sqrt F0) / (1 - sqrt F0): unpolarised light, no absorption
 *
 * 8 parameters: m, F0, and diffuse and specular albedo per channel. 32 bytes. The specular albedo
 * carries the colour and any constant (the 1/pi of the original against the 1/4 of later texts).
 */
#include "lobe.h"

static double fresnel(double f0, double c)
{
	double root = sqrt(f0), n = (1 + root) / (1 - root), g = sqrt(n * n + c * c - 1);
	double a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);

	return 0.5 * a * a * (1 + b * b);
}

static double cook_torrance_value(const double *shape, struct cell_angles a)
{
	double m2 = shape[0] * shape[0], cos2 = a.cos_h * a.cos_h;
	double d = exp(-(1 / cos2 - 1) / m2) / (m2 * cos2 * cos2);
	double g = fmin(1, 2 * a.cos_h * fmin(a.cos_i, a.cos_o) / a.cos_d);

	return fresnel(fmin(shape[1], 0.999999), a.cos_d) * d * g / (M_PI * a.cos_i * a.cos_o);
}

const struct lobe_model LOBE_COOK_TORRANCE = {
	.shape_count = 2,
	.axis = {{LOBE_EXP, 0.003, 1.5, 24}, {LOBE_UNIT, 0.005, 0.9, 5}},
	.value = cook_torrance_value,
};

const struct baseline BASELINE_COOK_TORRANCE = LOBE_BASELINE("Cook and Torrance 1981", LOBE_COOK_TORRANCE, LOBE_COSINE);
const struct baseline BASELINE_COOK_TORRANCE_RELATIVE =
	LOBE_BASELINE("Cook and Torrance 1981; relative error", LOBE_COOK_TORRANCE, LOBE_RELATIVE);
