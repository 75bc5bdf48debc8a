/*
 * default_grid_parts.h: what default_grid.c and default_grid_refine.c share.
 */
#ifndef MODEL_DEFAULT_GRID_PARTS_H
#define MODEL_DEFAULT_GRID_PARTS_H

#include <math.h>

#include "default_grid.h"

/* The coefficients r * phi_d + lane of the rows that count; `continue` in its body is the next one. */
#define GRID_FOR_EACH(e, r, at)                                                                                       \
	for (size_t r = 0; r < (size_t)(e)->dims.theta_h * (e)->dims.theta_d; r++)                               \
		for (size_t at = r * (e)->dims.phi_d; (e)->exact[r] && at < (r + 1) * (e)->dims.phi_d; at++)

static inline double grid_length(const struct grid_evidence *e, size_t at)
{
	const double x = (double)e->spectrum[0][at], y = (double)e->spectrum[1][at], z = (double)e->spectrum[2][at];
	return sqrt(x * x + y * y + z * z);
}

static inline double grid_along(const struct grid_evidence *e, size_t at, const double axis[3])
{
	return axis[0] * (double)e->spectrum[0][at] + axis[1] * (double)e->spectrum[1][at] + axis[2] * (double)e->spectrum[2][at];
}

/* Of harmonic 0's coarsest band, where a constant goes? */
static inline bool grid_is_coarsest(struct lattice_dims d, size_t r, uint32_t harmonic)
{
	const uint32_t levels = spectrum_levels(d.theta_h, d.theta_d);
	return harmonic == 0 && r / d.theta_d < spectrum_extent(d.theta_h, levels) && r % d.theta_d < spectrum_extent(d.theta_d, levels);
}

/* Axis n becomes the part of `a` across the axes before it, of length 1. */
void grid_axis_set(double axis[3][3], int n, const double a[3]);

/* Axes, step and centre[1] from ever larger levels: what levels of 1 tell of them is not enough for levels of 10,000. */
void grid_refine(const struct grid_evidence *evidence, double axis[3][3], struct default_grid *grid);

#endif
