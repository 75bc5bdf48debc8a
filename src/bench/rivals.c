#include "rivals.h"

#include <math.h>

#include "timing.h"

static double ggx_density(double alpha, const float wi[3], const float wo[3])
{
	double h[3], length = 0, a2 = alpha * alpha, z = (double)wo[2];
	for (int c = 0; c < 3; c++) {
		h[c] = (double)wi[c] + (double)wo[c];
		length += h[c] * h[c];
	}
	double t = h[2] * h[2] / length * (a2 - 1) + 1, d = a2 / (M_PI * t * t);
	double masking = 2 * z / (z + sqrt(a2 + (1 - a2) * z * z));
	return d * masking / (4 * z);
}

static void ggx_draw(double alpha, const float wo[3], double u1, double u2, float wi[3])
{
	/* wo in the frame where the lobe is a hemisphere, and two axes across it; wo has no y component */
	double x = alpha * (double)wo[0], z = (double)wo[2], n = hypot(x, z);
	x /= n;
	z /= n;
	double r = sqrt(u1), phi = 2 * M_PI * u2, t1 = r * cos(phi), t2 = r * sin(phi), s = 0.5 * (1 + z);
	t2 = (1 - s) * sqrt(fmax(0, 1 - t1 * t1)) + s * t2;
	double up = sqrt(fmax(0, 1 - t1 * t1 - t2 * t2));
	/* axes: (0, 1, 0) and wo x (0, 1, 0) = (-z, 0, x) */
	double h[3] = {alpha * (up * x - t2 * z), alpha * t1, fmax(0, up * z + t2 * x)};
	n = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
	double dot = 2 * (h[0] * (double)wo[0] + h[2] * (double)wo[2]) / n;
	for (int c = 0; c < 3; c++)
		wi[c] = (float)(dot * h[c] / n - (double)wo[c]);
}

/* wi for wo; returns its density, 0 for a lobe's sample below the horizon. */
static double sample_draw(const bp_material *material, const struct ggx_mixture *mixture, const float wo[3],
                          unsigned long long *u, float wi[3])
{
	const double u1 = uniform_next(u), u2 = uniform_next(u), u3 = uniform_next(u);
	if (!mixture)
		return (double)bp_material_sample(material, wo, (const float[]){(float)u1, (float)u2, (float)u3}, wi);
	if (u3 < mixture->share) {
		ggx_draw(mixture->roughness, wo, u1, u2, wi);
	} else {
		wi[0] = (float)(sqrt(u1) * cos(2 * M_PI * u2));
		wi[1] = (float)(sqrt(u1) * sin(2 * M_PI * u2));
		wi[2] = (float)sqrt(1 - u1);
	}
	if (!(wi[2] > 0))
		return 0;
	const double lobe = mixture->share > 0 ? mixture->share * ggx_density(mixture->roughness, wi, wo) : 0;
	return (1 - mixture->share) * (double)wi[2] / M_PI + lobe;
}

struct spread spread_of(const bp_material *material, const struct ggx_mixture *mixture, double theta_o, int samples,
                        unsigned long long *u)
{
	const float wo[3] = {(float)sin(theta_o), 0, (float)cos(theta_o)};
	double sum = 0, squares = 0;
	for (int n = 0; n < samples; n++) {
		float wi[3], rgb[3];
		const double pdf = sample_draw(material, mixture, wo, u, wi);
		if (pdf == 0)
			continue;
		bp_material_evaluate(material, wi, wo, rgb);
		const double weight = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3 * (double)wi[2] / pdf;
		sum += weight;
		squares += weight * weight;
	}
	const double mean = sum / samples, variance = squares / samples - mean * mean;
	return (struct spread){mean > 0 ? sqrt(fmax(0, variance)) / mean : 0, mean};
}

struct ggx_mixture ggx_fit(const bp_material *material, const double *theta_o, int angles, unsigned long long *u)
{
	enum { SAMPLES = 3000 };
	struct ggx_mixture best = {0, 0};
	double least = INFINITY;
	for (double roughness = 0.004; roughness < 1; roughness *= 1.4)
		for (int share = 1; share < 10; share += 2) {
			struct ggx_mixture mixture = {roughness, share / 10.0};
			double sum = 0;
			for (int n = 0; n < angles; n++) {
				double deviation = spread_of(material, &mixture, theta_o[n], SAMPLES, u).deviation;
				sum += deviation * deviation;
			}
			if (sum < least) {
				least = sum;
				best = mixture;
			}
		}
	return best;
}
