#include "warped.h"

#include <math.h>

#include "rgl/grid.h"

/* The slice at or before theta_i, and how far it is to the next. */
static uint32_t angle_find(const struct warped *warped, double theta_i, double *weight)
{
	uint32_t angle = 0;
	while (angle + 2 < warped->shape.angles && warped->theta_i[angle + 1] <= theta_i)
		angle++;
	const double step = (double)warped->theta_i[angle + 1] - warped->theta_i[angle];
	*weight = fmin((theta_i - warped->theta_i[angle]) / step, 1);
	return angle;
}

void warped_evaluate(const struct warped *warped, const float wi[3], const float wo[3], double rgb[3])
{
	rgb[0] = rgb[1] = rgb[2] = 0;
	if (!(wi[2] > 0 && wo[2] > 0))
		return;
	const struct normals *normals = &warped->normals;
	const double m[3] = {(double)wi[0] + wo[0], (double)wi[1] + wo[1], (double)wi[2] + wo[2]};
	const double theta_i = atan2(hypot(wi[0], wi[1]), wi[2]), theta_m = atan2(hypot(m[0], m[1]), m[2]);
	const double turn = (atan2(m[1], m[0]) - atan2(wi[1], wi[0])) / (2 * M_PI) + 0.5;
	const double u[2] = {normals_u(theta_m), turn - floor(turn)};
	double at[2], weight;
	const uint32_t angle = angle_find(warped, theta_i, &weight), size = warped->shape.size;
	warp_inverse(&warped->visible, (struct warp_place){angle, weight}, u, at);
	const double area = normals_at(normals, normals->area, normals_u(theta_i));
	const double factor = normals_at(normals, normals->density, u[0]) / (4 * area);
	const size_t points = (size_t)size * size;
	for (size_t c = 0; c < 3; c++) {
		const float *grid = warped->rgb + (angle * 3 + c) * points;
		rgb[c] = factor * ((1 - weight) * grid_bilinear(grid, size, size, at[0], at[1]) +
		                   weight * grid_bilinear(grid + 3 * points, size, size, at[0], at[1]));
	}
}
