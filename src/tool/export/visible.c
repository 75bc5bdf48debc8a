#include "visible.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "reflectance.h"

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

bp_status visible_make(const struct normals *normals, struct visible_mix mix, size_t angles, const float *theta_i, size_t width,
                       size_t height, struct warp *out, bp_error *error)
{
	const double across = (double)(width - 1), up = (double)(height - 1);
	double *density = malloc(width * height * sizeof *density);
	bp_status status = BP_OK;
	if (!warp_alloc(out, angles, height, width, across, up) || !density)
		status = error_memory(error, (angles * (sizeof(double) + sizeof(float)) + sizeof(double)) * width * height);
	for (size_t angle = 0; angle < angles && !status; angle++) {
		size_t n = 0;
		for (size_t y = 0; y < height; y++)
			for (size_t x = 0; x < width; x++)
				density[n++] = (float)density_at(normals, mix, theta_i[angle], (double)x / across, (double)y / up);
		if (warp_fill(out, angle, density, &n))
			status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "there is no density of visible normals at theta_i = %g",
			                   theta_i[angle]);
	}
	free(density);
	return status;
}

void visible_mirror(const double wi[3], const double at[2], double wo[3])
{
	double m[3];
	direction_at(normals_theta(at[0]), (2 * at[1] - 1) * M_PI, m);
	const double facing = wi[0] * m[0] + wi[1] * m[1] + wi[2] * m[2];
	for (int axis = 0; axis < 3; axis++)
		wo[axis] = 2 * facing * m[axis] - wi[axis];
}
