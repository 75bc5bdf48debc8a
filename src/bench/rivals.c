#include "rivals.h"

#include <math.h>

#include "timing.h"

static void outgoing(double theta_o, float wo[3])
{
	wo[0] = (float)sin(theta_o);
	wo[1] = 0;
	wo[2] = (float)cos(theta_o);
}

static double mean_value(const bp_material *material, const float wi[3], const float wo[3])
{
	float rgb[3];
	bp_material_evaluate(material, wi, wo, rgb);
	return ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
}

struct sums {
	double weight, square;
	int count;
};

/* A sample drawn with this density. */
static void sums_add(struct sums *sums, const bp_material *material, const float wi[3], const float wo[3], double pdf)
{
	double weight = mean_value(material, wi, wo) * (double)wi[2] / pdf;
	sums->weight += weight;
	sums->square += weight * weight;
}

static struct spread sums_end(const struct sums *sums)
{
	double mean = sums->weight / sums->count, variance = sums->square / sums->count - mean * mean;
	return (struct spread){mean > 0 ? sqrt(fmax(0, variance)) / mean : 0, mean};
}

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

struct spread spread_of_ggx(const bp_material *material, struct ggx_mixture mixture, double theta_o, int samples,
                            unsigned long long *u)
{
	struct sums sums = {.count = samples};
	float wo[3], wi[3];
	outgoing(theta_o, wo);
	for (int n = 0; n < samples; n++) {
		double u1 = uniform_next(u), u2 = uniform_next(u);
		if (uniform_next(u) < mixture.share) {
			ggx_draw(mixture.roughness, wo, u1, u2, wi);
		} else {
			wi[0] = (float)(sqrt(u1) * cos(2 * M_PI * u2));
			wi[1] = (float)(sqrt(u1) * sin(2 * M_PI * u2));
			wi[2] = (float)sqrt(1 - u1);
		}
		if (!(wi[2] > 0)) /* a lobe's sample below the horizon: weight 0 */
			continue;
		double pdf = (1 - mixture.share) * (double)wi[2] / M_PI;
		if (mixture.share > 0)
			pdf += mixture.share * ggx_density(mixture.roughness, wi, wo);
		sums_add(&sums, material, wi, wo, pdf);
	}
	return sums_end(&sums);
}

struct spread spread_of_material(const bp_material *material, double theta_o, int samples, unsigned long long *u)
{
	struct sums sums = {.count = samples};
	float wo[3], wi[3];
	outgoing(theta_o, wo);
	for (int n = 0; n < samples; n++) {
		const float numbers[3] = {(float)uniform_next(u), (float)uniform_next(u), (float)uniform_next(u)};
		const double pdf = (double)bp_material_sample(material, wo, numbers, wi);
		sums_add(&sums, material, wi, wo, pdf);
	}
	return sums_end(&sums);
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
				double deviation = spread_of_ggx(material, mixture, theta_o[n], SAMPLES, u).deviation;
				sum += deviation * deviation;
			}
			if (sum < least) {
				least = sum;
				best = mixture;
			}
		}
	return best;
}
