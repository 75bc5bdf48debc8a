#include "itp.h"

#include <math.h>

/* cd/m^2 of white, and of the largest signal of the perceptual quantizer */
static const double WHITE = 100, PEAK = 10000;

static double quantizer(double light)
{
	const double y = pow(light / PEAK, 2610.0 / 16384);
	return pow((3424.0 / 4096 + 2413.0 / 128 * y) / (1 + 2392.0 / 128 * y), 2523.0 / 32);
}

static double product(const double row[3], const double v[3]) { return row[0] * v[0] + row[1] * v[1] + row[2] * v[2]; }

void itp_of(const double rgb[3], double itp[3])
{
	static const double WIDE[3][3] = {{0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0114}, {0.0164, 0.0880, 0.8956}};
	static const double CONES[3][3] = {{1688, 2146, 262}, {683, 2951, 462}, {99, 309, 3688}};
	static const double OPPONENT[3][3] = {{4096, 4096, 0}, {6610, -13613, 7003}, {2 * 17933, -2 * 17390, -2 * 543}};
	double wide[3], cone[3];
	for (int n = 0; n < 3; n++)
		wide[n] = WHITE * product(WIDE[n], rgb);
	for (int n = 0; n < 3; n++)
		cone[n] = quantizer(product(CONES[n], wide) / 4096);
	for (int n = 0; n < 3; n++)
		itp[n] = product(OPPONENT[n], cone) / 8192;
}

double itp_difference(const double a[3], const double b[3])
{
	double squares = 0;
	for (int n = 0; n < 3; n++)
		squares += (a[n] - b[n]) * (a[n] - b[n]);
	return 720 * sqrt(squares);
}

bp_status itp_mean(const struct sphere_image *reference, const struct sphere_image *estimate, double *out, bp_error *error)
{
	double exposure, sum = 0;
	bp_status status = image_exposure(reference, &exposure, error);
	if (status != BP_OK)
		return status;
	const size_t pixels = (size_t)reference->size * reference->size;
	for (size_t n = 0; n < pixels; n++) {
		if (!reference->covered[n])
			continue;
		double a[3], b[3], itp_a[3], itp_b[3];
		for (size_t c = 0; c < 3; c++)
			image_pair(reference, estimate, 3 * n + c, exposure, image_clamped, &a[c], &b[c]);
		itp_of(a, itp_a);
		itp_of(b, itp_b);
		sum += itp_difference(itp_a, itp_b);
	}
	*out = reference->covered_count ? sum / (double)reference->covered_count : 0;
	return BP_OK;
}
