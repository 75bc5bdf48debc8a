/* grid.h: functions over the unit interval or square, given at equally spaced nodes, both ends among them, linear between. */
#ifndef RGL_GRID_H
#define RGL_GRID_H

#include <stddef.h>

/* The node before a coordinate in [0, 1], at most the last but one, and how far behind it the coordinate is, in steps. */
static inline size_t grid_node(double x, size_t nodes, double *fraction)
{
	const double scaled = x * (double)(nodes - 1);
	size_t node = (size_t)scaled;
	if (node > nodes - 2)
		node = nodes - 2;
	*fraction = scaled - (double)node;
	return node;
}

/* Bilinear at (x, y) of the unit square: rows of `width` values, `height` of them. */
static inline double grid_bilinear(const float *values, size_t width, size_t height, double x, double y)
{
	double fx, fy;
	const float *v = values + grid_node(x, width, &fx);
	v += grid_node(y, height, &fy) * width;
	return (1 - fy) * ((1 - fx) * (double)v[0] + fx * (double)v[1]) +
	       fy * ((1 - fx) * (double)v[width] + fx * (double)v[width + 1]);
}

#endif
