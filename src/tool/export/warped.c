#include "warped.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "error.h"

enum { PROFILE_ANGLES = 16 };

/* A direction at the horizon is taken this far above it, where the material still has values. */
static const double COSINE_LEAST = 1e-4;
/* A value beyond the horizon goes on by at most so many times the one before it. */
static const double BEYOND_MOST = 2;
/* Beyond the horizon samples are below 0 by this at least, by which they are told from those above it. */
static const double BEYOND_LEAST = 1e-30;
/* Readers divide by a slice's sum: one that is darker all over is sampled evenly. */
static const double LUMINANCE_LEAST = 1e-20;
/* Of a slice's mean: no place is darker. Readers' floats make of a 0 a density of some -1e-9, and weights of millions. */
static const double LUMINANCE_FLOOR = 1e-4;
/* theta_i grows with this power: closer nodes towards the horizon, where lobes change fastest. */
static const double ANGLES_POWER = 0.8;

/*
 * What stands for f(w, w) at the nodes: at each theta_h the mean of f over theta_d, weighted by cos theta_d, with phi_d = 90
 * degrees, where both directions are above the horizon whatever theta_d. Retroreflection alone (theta_d = 0) misses lobes that
 * rise towards grazing angles, and is what measurements know least about.
 */
static bp_status profile_make(const struct reflectance *reflectance, double *profile, bp_error *error)
{
	struct pairs pairs;
	if (!pairs_alloc(WARPED_NORMALS * PROFILE_ANGLES, &pairs))
		return error_memory(error, 9 * sizeof(float) * WARPED_NORMALS * PROFILE_ANGLES);
	for (uint32_t n = 0; n < WARPED_NORMALS; n++)
		for (uint32_t j = 0; j < PROFILE_ANGLES; j++) {
			const double theta = normals_theta(n / (WARPED_NORMALS - 1.0)), d = j * M_PI_2 / PROFILE_ANGLES;
			const double half[3] = {sin(theta), 0, fmax(cos(theta), COSINE_LEAST)};
			const double wi[3] = {half[0] * cos(d), sin(d), half[2] * cos(d)}, wo[3] = {wi[0], -wi[1], wi[2]};
			pairs_set(&pairs, n * PROFILE_ANGLES + j, wi, wo);
		}
	pairs_evaluate(&pairs, reflectance);
	for (uint32_t n = 0; n < WARPED_NORMALS; n++) {
		profile[n] = 0;
		for (uint32_t j = 0; j < PROFILE_ANGLES; j++) {
			const size_t at = n * PROFILE_ANGLES + j;
			const double sum = (double)pairs.rgb[0][at] + pairs.rgb[1][at] + pairs.rgb[2][at];
			profile[n] += sum * cos(j * M_PI_2 / PROFILE_ANGLES);
		}
	}
	pairs_free(&pairs);
	return BP_OK;
}

/*
 * The nodes of one slice: pairs of directions, and factor[size^2], which makes of f what `rgb` holds: cos theta_o 4 sigma/D; 0
 * where w_o is not above the horizon.
 */
static void nodes_place(const struct warped *warped, uint32_t angle, struct pairs *pairs, double *factor)
{
	const struct normals *normals = &warped->normals;
	const uint32_t size = warped->shape.size;
	const double theta_i = warped->theta_i[angle], area = normals_at(normals, normals->area, normals_u(theta_i));
	double wi[3];
	direction_at(theta_i, 0, wi);
	wi[2] = fmax(wi[2], COSINE_LEAST);
	for (uint32_t n = 0; n < size * size; n++) {
		const double at[2] = {n % size / (size - 1.0), n / size / (size - 1.0)};
		double u[2], wo[3];
		warp_forward(&warped->visible, angle, at, u);
		visible_mirror(wi, u, wo);
		pairs_set(pairs, n, wi, wo);
		factor[n] = fmax(wo[2], 0) * 4 * area / normals_at(normals, normals->density, u[0]);
	}
}

/*
 * Where w_o is below the horizon: below 0; beside a node that is not, the straight continuation of the two values before it.
 * Readers interpolate across the horizon, and with a 0 here f cos theta_o would be too large just above it.
 */
static void horizon_cross(uint32_t size, const double *factor, float *plane)
{
	const int64_t n = size;
	for (int64_t y = 0; y < n; y++)
		for (int64_t x = 0; x < n; x++) {
			double sum = 0;
			int count = 0;
			if (factor[y * n + x] > 0)
				continue;
			for (int64_t step = 0; step < 9; step++) {
				const int64_t dx = step % 3 - 1, dy = step / 3 - 1, far_x = x + 2 * dx, far_y = y + 2 * dy;
				const int64_t near = (y + dy) * n + x + dx, far = far_y * n + far_x;
				if ((dx == 0 && dy == 0) || far_x < 0 || far_y < 0 || far_x >= n || far_y >= n || factor[near] <= 0 ||
				    factor[far] <= 0)
					continue;
				sum += fmax(fmin(2 * (double)plane[near] - plane[far], 0), -BEYOND_MOST * plane[near]);
				count++;
			}
			plane[y * n + x] = (float)fmin(count > 0 ? sum / count : 0, -BEYOND_LEAST);
		}
}

/* False where a value is beyond what a float holds. */
static bool slice_fill(struct warped *warped, uint32_t angle, const struct pairs *pairs, const double *factor)
{
	const size_t points = (size_t)warped->shape.size * warped->shape.size;
	bool whole = true;
	for (size_t c = 0; c < 3; c++) {
		float *plane = warped->rgb + (angle * 3 + c) * points;
		for (size_t n = 0; n < points; n++) {
			const double value = pairs->rgb[c][n] * factor[n];
			whole &= value < FLT_MAX / 4;
			plane[n] = (float)fmin(value, FLT_MAX);
		}
		horizon_cross(warped->shape.size, factor, plane);
	}
	return whole;
}

/* The mean of the channels, by which readers draw. */
static void luminance_fill(struct warped *warped, uint32_t angle)
{
	const size_t points = (size_t)warped->shape.size * warped->shape.size;
	float *luminance = warped->luminance + angle * points;
	const float *rgb = warped->rgb + angle * 3 * points;
	double sum = 0;
	for (size_t n = 0; n < points; n++) {
		luminance[n] = (float)fmax(((double)rgb[n] + rgb[points + n] + rgb[2 * points + n]) / 3, 0);
		sum += (double)luminance[n];
	}
	const float least = (float)(LUMINANCE_FLOOR * sum / (double)points);
	for (size_t n = 0; n < points; n++)
		luminance[n] = sum < LUMINANCE_LEAST ? 1 : fmaxf(luminance[n], least);
}

static bp_status slices_make(const struct reflectance *reflectance, struct warped *warped, bp_error *error)
{
	const size_t points = (size_t)warped->shape.size * warped->shape.size;
	struct pairs pairs;
	double *factor = malloc(points * sizeof *factor);
	bp_status status = pairs_alloc(points, &pairs) && factor ? BP_OK : error_memory(error, points * sizeof *factor);
	for (uint32_t angle = 0; !status && angle < warped->shape.angles; angle++) {
		nodes_place(warped, angle, &pairs, factor);
		pairs_evaluate(&pairs, reflectance);
		if (!slice_fill(warped, angle, &pairs, factor))
			status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "it has values beyond what a float holds");
	}
	pairs_free(&pairs);
	free(factor);
	return status;
}

bp_status warped_make(const struct reflectance *reflectance, const struct warped_shape *shape, struct warped *out,
                      bp_error *error)
{
	const size_t points = (size_t)shape->size * shape->size, floats = shape->angles * (1 + 4 * points);
	double profile[WARPED_NORMALS];
	*out = (struct warped){.shape = *shape, .theta_i = malloc(floats * sizeof(float))};
	if (!out->theta_i)
		return error_memory(error, floats * sizeof(float));
	out->luminance = out->theta_i + shape->angles;
	out->rgb = out->luminance + shape->angles * points;
	for (uint32_t n = 0; n < shape->angles; n++)
		out->theta_i[n] = (float)(pow(n / (shape->angles - 1.0), ANGLES_POWER) * M_PI_2);
	bp_status status = profile_make(reflectance, profile, error);
	if (!status)
		status = normals_make(WARPED_NORMALS, profile, &out->normals, error);
	if (!status)
		status = visible_make(&out->normals, shape->mix, shape->angles, out->theta_i, shape->width, shape->height, &out->visible,
		                      error);
	if (!status)
		status = slices_make(reflectance, out, error);
	if (!status)
		status = warped_settle(reflectance, out, error);
	for (uint32_t angle = 0; !status && angle < shape->angles; angle++)
		luminance_fill(out, angle);
	return status;
}

void warped_free(struct warped *warped)
{
	normals_free(&warped->normals);
	warp_free(&warped->visible);
	free(warped->theta_i);
	*warped = (struct warped){0};
}
