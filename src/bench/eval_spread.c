/* The spread of the sampling weights, beside the usual ways to sample measured materials. */
#include "eval_spread.h"

#include <math.h>
#include <stdio.h>

#include "eval_timing.h"
#include "rivals.h"

enum { SPREAD_SAMPLES = 20000 };

/* One row of the sampling table; adds to sums. */
void spread_print(const bp_archive *archive, uint64_t index, const char *name, double sums[3])
{
	const double degrees[] = {2, 10, 25, 40, 60, 75, 84, 88};
	enum { ANGLES = sizeof degrees / sizeof *degrees };
	double theta[ANGLES], seconds, mean[3] = {0}, worst = 0;
	unsigned long long u = 1;
	bp_material *material = eval_load(archive, index, BP_FORM_EXPANDED, 1, 0, &seconds);
	if (!material)
		return;
	for (int n = 0; n < ANGLES; n++)
		theta[n] = degrees[n] * M_PI / 180;
	struct ggx_mixture fitted = ggx_fit(material, theta, ANGLES, &u);
	for (int n = 0; n < ANGLES; n++) {
		struct spread ours = spread_of_material(material, theta[n], 10 * SPREAD_SAMPLES, &u);
		float rgb[3];
		bp_material_albedo(material, (float)theta[n], rgb);
		double albedo = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
		worst = fmax(worst, fabs(ours.albedo / albedo - 1));
		mean[0] += ours.deviation / ANGLES;
		mean[1] += spread_of_ggx(material, (struct ggx_mixture){0, 0}, theta[n], SPREAD_SAMPLES, &u).deviation / ANGLES;
		mean[2] += spread_of_ggx(material, fitted, theta[n], SPREAD_SAMPLES, &u).deviation / ANGLES;
	}
	printf("%s\t%.3f\t%.3f\t%.3f\t%.3f\t%.1f\t%.5f\n", name, mean[0], mean[1], mean[2], fitted.roughness, fitted.share, worst);
	fflush(stdout);
	for (int n = 0; n < 3; n++)
		sums[n] += mean[n];
	bp_material_free(material);
}
