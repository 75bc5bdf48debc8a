#include "visible.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "reflectance.h"
#include "rgl/grid.h"

/* Density over (u, v): a solid angle dm is 2 pi^2 u sin theta du dv. */
static double density_at(const struct normals *normals, struct visible_mix mix, double theta_i, double u, double v)
{
	const double theta = normals_theta(u), turn = (2 * v - 1) * M_PI, u_i = normals_u(theta_i);
	const double facing = sin(theta_i) * sin(theta) * cos(turn) + cos(theta_i) * cos(theta);
	if (facing <= 0)
		return 0;
	const double own = normals_at(normals, normals->density, u) / normals_at(normals, normals->area, u_i);
	const double soft = normals_at(normals, normals->soft, u) / normals_at(normals, normals->soft_area, u_i);
	const double uniform = 2 / (M_PI * (1 + cos(theta_i)));
	const double mixed = (1 - mix.soft - mix.uniform) * own + mix.soft * soft + mix.uniform * uniform;
	return mixed * facing * 2 * M_PI * M_PI * u * sin(theta);
}

/* The integrals of one angle's density, which is brought to mass 1. */
static void integrals_fill(struct visible *visible, uint32_t angle)
{
	const size_t width = visible->width, height = visible->height;
	float *density = visible->density + angle * width * height;
	double *lines = visible->lines + angle * width * height, *below = visible->below + angle * height;
	for (size_t y = 0; y < height; y++) {
		double sum = 0;
		for (size_t x = 0; x < width; x++) {
			sum += x > 0 ? ((double)density[y * width + x - 1] + density[y * width + x]) / (2 * (double)(width - 1)) : 0;
			lines[y * width + x] = sum;
		}
		below[y] = y > 0 ? below[y - 1] + (lines[y * width - 1] + sum) / (2 * (double)(height - 1)) : 0;
	}
	const double scale = 1 / below[height - 1];
	for (size_t n = 0; n < width * height; n++) {
		density[n] = (float)(density[n] * scale);
		lines[n] *= scale;
	}
	for (size_t y = 0; y < height; y++)
		below[y] *= scale;
}

bp_status visible_make(const struct normals *normals, struct visible_mix mix, uint32_t angles, const float *theta_i,
                       uint32_t width, uint32_t height, struct visible *out, bp_error *error)
{
	const size_t points = (size_t)angles * width * height, lines = (size_t)angles * height;
	const size_t bytes = (points + lines) * sizeof(double) + points * sizeof(float);
	double *block = malloc(bytes);
	if (!block)
		return error_memory(error, bytes);
	*out = (struct visible){angles, width, height, (float *)(block + points + lines), block, block + points};
	for (uint32_t angle = 0; angle < angles; angle++) {
		float *density = out->density + (size_t)angle * width * height;
		for (uint32_t y = 0; y < height; y++)
			for (uint32_t x = 0; x < width; x++)
				*density++ = (float)density_at(normals, mix, theta_i[angle], x / (width - 1.0), y / (height - 1.0));
		integrals_fill(out, angle);
	}
	return BP_OK;
}

void visible_free(struct visible *visible)
{
	free(visible->lines);
	*visible = (struct visible){0};
}

void visible_mirror(const double wi[3], const double at[2], double wo[3])
{
	double m[3];
	direction_at(normals_theta(at[0]), (2 * at[1] - 1) * M_PI, m);
	const double facing = wi[0] * m[0] + wi[1] * m[1] + wi[2] * m[2];
	for (int axis = 0; axis < 3; axis++)
		wo[axis] = 2 * facing * m[axis] - wi[axis];
}

/* The integral from 0 to t of a line that goes from a to b within a unit. */
static double segment(double t, double a, double b) { return t * (a + 0.5 * t * (b - a)); }

/* Where that integral has the value `mass`, in [0, 1]. */
static double segment_find(double mass, double a, double b)
{
	const double root = sqrt(fmax(0, a * a + 2 * mass * (b - a))), sum = a + root;
	return sum > 0 ? fmin(fmax(2 * mass / sum, 0), 1) : 0;
}

static double between(double a, double b, double weight) { return a + (b - a) * weight; }

/* An integral at a node: of one angle and, by weight, of the next one, which lies `next` values on. */
static double mixed(const double *values, size_t next, double weight)
{
	return weight > 0 ? between(values[0], values[next], weight) : values[0];
}

static double mixed_density(const float *values, size_t next, double weight)
{
	return weight > 0 ? between(values[0], values[next], weight) : values[0];
}

void visible_warp(const struct visible *visible, uint32_t angle, double weight, const double at[2], double out[2])
{
	const size_t width = visible->width, points = width * visible->height;
	double fx, fy;
	const size_t x = grid_node(at[0], width, &fx), y = grid_node(at[1], visible->height, &fy);
	const float *corner = visible->density + angle * points + y * width + x;
	const double left = between(mixed_density(corner, points, weight), mixed_density(corner + width, points, weight), fy);
	const double right =
		between(mixed_density(corner + 1, points, weight), mixed_density(corner + width + 1, points, weight), fy);
	const double *low = visible->lines + angle * points + y * width, *high = low + width;
	const double before = between(mixed(low + x, points, weight), mixed(high + x, points, weight), fy);
	const double mass_low = mixed(low + width - 1, points, weight), mass_high = mixed(high + width - 1, points, weight);
	const double mass = between(mass_low, mass_high, fy), part = segment(fx, left, right) / (visible->width - 1.0);
	const double below = mixed(visible->below + (size_t)angle * visible->height + y, visible->height, weight);
	out[0] = mass > 0 ? fmin((before + part) / mass, 1) : fx;
	out[1] = fmin(below + segment(fy, mass_low, mass_high) / (visible->height - 1.0), 1);
}

void visible_unwarp(const struct visible *visible, uint32_t angle, const double at[2], double out[2])
{
	const size_t width = visible->width, points = width * visible->height;
	const double *below = visible->below + (size_t)angle * visible->height;
	uint32_t x = 0, y = 0;
	while (y + 2 < visible->height && below[y + 1] <= at[1])
		y++;
	const double *low = visible->lines + angle * points + y * width, *high = low + width;
	const double fy = segment_find((at[1] - below[y]) * (visible->height - 1.0), low[width - 1], high[width - 1]);
	const double mass = at[0] * between(low[width - 1], high[width - 1], fy);
	while (x + 2 < visible->width && between(low[x + 1], high[x + 1], fy) <= mass)
		x++;
	const float *corner = visible->density + angle * points + y * width + x;
	const double left = between(corner[0], corner[width], fy), right = between(corner[1], corner[width + 1], fy);
	const double fx = segment_find((mass - between(low[x], high[x], fy)) * (visible->width - 1.0), left, right);
	out[0] = (x + fx) / (visible->width - 1.0);
	out[1] = (y + fy) / (visible->height - 1.0);
}
