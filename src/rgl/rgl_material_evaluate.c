/* rgl_material_evaluate.c: the function that a material's file stands for, at one pair of directions. */
#include <math.h>

#include "grid.h"
#include "rgl_material.h"

#define PI 3.14159265358979323846

static double grid_at(const struct rgl_grid *grid, double x, double y)
{
	return grid_bilinear(grid->values, grid->width, grid->height, x, y);
}

/* The last angle that is not above theta, and how far theta is on its way to the next. */
static struct warp_place place_of(const struct rgl_material *material, double theta)
{
	size_t low = 0, high = material->angles; /* theta_i[low] <= theta < theta_i[high], where these are there */
	while (high - low > 1) {
		const size_t middle = (low + high) / 2;
		if (material->theta_i[middle] <= theta)
			low = middle;
		else
			high = middle;
	}
	if (high == material->angles)
		return (struct warp_place){low, 0};
	const double next = (theta - material->theta_i[low]) / (material->theta_i[high] - material->theta_i[low]);
	return (struct warp_place){low, next > 0 ? next : 0};
}

/* Adds one angle's samples at s, bilinear. */
static void samples_add(const struct rgl_material *material, size_t angle, double weight, const double s[2], double sum[4])
{
	double fx, fy;
	const size_t ix = grid_node(s[0], material->width, &fx), iy = grid_node(s[1], material->height, &fy);
	const float *v = material->samples + 4 * ((angle * material->height + iy) * material->width + ix);
	const float *below = v + 4 * material->width;
	const double a = weight * (1 - fy) * (1 - fx), b = weight * (1 - fy) * fx, c = weight * fy * (1 - fx), d = weight * fy * fx;
	for (int n = 0; n < 4; n++)
		sum[n] += a * (double)v[n] + b * (double)v[4 + n] + c * (double)below[n] + d * (double)below[4 + n];
}

static double elevation_coordinate(double theta) { return sqrt(fmin(theta * (2 / PI), 1)); }

static double azimuth_coordinate(double phi)
{
	const double turns = phi / (2 * PI) + 0.5;
	return turns - floor(turns);
}

void rgl_evaluate(const struct rgl_material *material, double theta_i, double phi_i, double theta_m, double cos_o,
                  struct rgl_value *out)
{
	const struct warp_place place = place_of(material, theta_i);
	const double at[2] = {elevation_coordinate(theta_m), azimuth_coordinate(-phi_i)};
	double s[2], sum[4] = {0}, factor = 1 / cos_o;

	warp_inverse(&material->vndf, place, at, s);
	samples_add(material, place.slice, 1 - place.next, s, sum);
	if (place.next > 0)
		samples_add(material, place.slice + 1, place.next, s, sum);
	out->data = sum[3];
	if (material->jacobian) {
		const double area = 4 * grid_at(&material->sigma, elevation_coordinate(theta_i), azimuth_coordinate(phi_i));
		factor *= area > 0 ? grid_at(&material->ndf, at[0], at[1]) / area : 0;
		if (!(area > 0))
			out->data = 0;
	}
	for (int c = 0; c < 3; c++)
		out->rgb[c] = fmax(sum[c], 0) * factor;
}

double rgl_samples_between(const struct rgl_material *material, size_t angle, double theta_m0, double theta_m1)
{
	return warp_spread(&material->vndf, angle, elevation_coordinate(theta_m0), elevation_coordinate(theta_m1)) *
	       (double)(material->width - 1);
}
