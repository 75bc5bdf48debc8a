#include "image.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "model/math/select.h"

bp_status image_exposure(const struct sphere_image *reference, double *exposure, bp_error *error)
{
	size_t pixels = (size_t)reference->size * reference->size, count = 0;
	double *mean = malloc((reference->covered_count + 1) * sizeof *mean);
	if (!mean)
		return error_memory(error, reference->covered_count * sizeof *mean);
	for (size_t n = 0; n < pixels; n++) {
		const float *rgb = reference->rgb + 3 * n;
		if (reference->covered[n])
			mean[count++] = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
	}
	*exposure = 0.9 / fmax(1e-12, count ? select_kth(mean, count, (size_t)(0.9 * (double)count)) : 0);
	free(mean);
	return BP_OK;
}

double image_clamped(double linear) { return linear < 0 ? 0 : linear > 1 ? 1 : linear; }

double image_srgb(double linear)
{
	double x = image_clamped(linear);
	return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}
