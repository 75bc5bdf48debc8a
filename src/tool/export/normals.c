#include "normals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"

enum { ROUNDS_MAX = 200, PARTS = 4 }; /* PARTS: midpoints of the quadrature between two nodes */

static const double SETTLED = 1e-9;
/* The last node lies at the horizon, where f cos theta is 0: D goes on as if the cosine were this. */
static const double COSINE_LEAST = 0.01;
/* D falls nowhere below this (uniform: 1/pi): other directions may reflect where the profile shows nothing. */
static const double DENSITY_LEAST = 1e-5;

double normals_u(double theta) { return sqrt(theta / M_PI_2); }

double normals_theta(double u) { return u * u * M_PI_2; }

double normals_at(const struct normals *normals, const double *values, double u)
{
	const double place = fmin(fmax(u, 0), 1) * (normals->count - 1);
	const uint32_t n = place >= normals->count - 1 ? normals->count - 2 : (uint32_t)place;
	return values[n] + (values[n + 1] - values[n]) * (place - n);
}

/* The integral over phi of max(0, w.m), for w and m at angles of these cosines and sines. */
static double facing(double cos_w, double sin_w, double cos_m, double sin_m)
{
	const double a = cos_w * cos_m, b = sin_w * sin_m;
	if (a >= b)
		return 2 * M_PI * a;
	const double phi = acos(-a / b);
	return 2 * (a * phi + b * sin(phi));
}

/* weights[count]: with D's values at the nodes their scalar product is the projected area of the direction w at node `row`. */
static void weights_fill(uint32_t count, uint32_t row, double *weights)
{
	const double theta_w = normals_theta((double)row / (count - 1)), cos_w = cos(theta_w), sin_w = sin(theta_w);
	memset(weights, 0, count * sizeof *weights);
	for (uint32_t n = 0; n + 1 < count; n++)
		for (int part = 0; part < PARTS; part++) {
			const double along = (part + 0.5) / PARTS, u = (n + along) / (count - 1), theta = normals_theta(u);
			const double du = 1.0 / ((count - 1) * PARTS), solid = sin(theta) * M_PI * u * du;
			const double weight = facing(cos_w, sin_w, cos(theta), sin(theta)) * solid;
			weights[n] += weight * (1 - along);
			weights[n + 1] += weight * along;
		}
}

/* The areas of a density of any scale, which is brought to area 1 at normal incidence: that is the integral of D cos theta. */
static void areas_fill(uint32_t count, const double *weights, double *density, double *area)
{
	for (uint32_t row = 0; row < count; row++) {
		area[row] = 0;
		for (uint32_t n = 0; n < count; n++)
			area[row] += weights[(size_t)row * count + n] * density[n];
	}
	const double scale = 1 / area[0];
	for (uint32_t n = 0; n < count; n++) {
		density[n] *= scale;
		area[n] *= scale;
	}
}

/* One round: D = profile cos theta sigma. Returns how much sigma at the horizon has changed. */
static double iterate(const double *weights, const double *profile, struct normals *normals)
{
	const uint32_t count = normals->count;
	const double before = normals->area[count - 1];
	double largest = 0;
	for (uint32_t n = 0; n < count; n++) {
		const double cosine = cos(normals_theta((double)n / (count - 1)));
		normals->density[n] = profile[n] * fmax(cosine, COSINE_LEAST) * normals->area[n];
		largest = fmax(largest, normals->density[n]);
	}
	for (uint32_t n = 0; n < count; n++)
		normals->density[n] = largest > 0 ? normals->density[n] / largest : 1;
	areas_fill(count, weights, normals->density, normals->area);
	return fabs(normals->area[count - 1] - before);
}

bp_status normals_make(uint32_t count, const double *profile, struct normals *out, bp_error *error)
{
	const size_t cells = (size_t)count * count;
	double *weights = malloc(cells * sizeof *weights), *values = malloc(4 * (size_t)count * sizeof *values);
	if (!weights || !values) {
		free(weights);
		free(values);
		return error_memory(error, cells * sizeof *weights);
	}
	*out = (struct normals){count, values, values + count, values + 2 * (size_t)count, values + 3 * (size_t)count};
	for (uint32_t row = 0; row < count; row++) {
		weights_fill(count, row, weights + (size_t)row * count);
		out->area[row] = 1;
	}
	for (int round = 0; round < ROUNDS_MAX && iterate(weights, profile, out) > SETTLED; round++)
		;
	for (uint32_t n = 0; n < count; n++)
		out->density[n] = fmax(out->density[n], DENSITY_LEAST);
	areas_fill(count, weights, out->density, out->area);
	for (uint32_t n = 0; n < count; n++)
		out->soft[n] = sqrt(out->density[n]);
	areas_fill(count, weights, out->soft, out->soft_area);
	free(weights);
	return BP_OK;
}

void normals_free(struct normals *normals)
{
	free(normals->density);
	*normals = (struct normals){0};
}
