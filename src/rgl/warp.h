/*
 * warp.h: densities over the unit square, one to each angle of incidence, and the map that makes them uniform.
 *
 * A slice is a grid of height x width values at the nodes of the square, bilinear between them; x runs along a row. With the
 * slice's integral made 1, the map sends a point (x, y) to
 *
 *     s_y = integral of the density over all x and over y' < y, whose part within a strip of rows is quadratic in y
 *     s_x = integral over x' < x along the row at y, over that of the whole row
 *
 * the marginal and the conditional distribution function. Between two angles density and integrals are interpolated linearly.
 * (Dupuy and Jakob 2018, section 4: the parameterisation by which measurements follow the visible normals.)
 */
#ifndef RGL_WARP_H
#define RGL_WARP_H

#include <stddef.h>

struct warp {
	size_t slices, height, width; /* height and width at least 2 */
	float *density;               /* [slices][height][width], of integral 1 per slice on a grid of spacing 1 */
	float *along_row;             /* [slices][height][width]: integral from the row's beginning to the node */
	float *along_column;          /* [slices][height]: integral of all rows before */
};

/* No values yet. False: no memory. warp_free in any case. */
int warp_alloc(struct warp *warp, size_t slices, size_t height, size_t width);
void warp_free(struct warp *warp);

/*
 * Fills one slice from height x width values, which are changed. Returns 0; -1 where one is negative, NaN or infinite, and *at is which; -2 where
 * their integral is 0 or beyond what float holds.
 */
int warp_fill(struct warp *warp, size_t slice, double *values, size_t *at);

/* Where a point is between two angles: that of the slice, and of the next one with the weight `next`, 0 to 1 (0: there need be no next one). */
struct warp_place {
	size_t slice;
	double next;
};

/* (x, y) in the unit square -> (sx, sy), in it too. */
void warp_invert(const struct warp *warp, struct warp_place place, double x, double y, double *sx, double *sy);

/* The most that s_x grows from x0 to x1 along any row of a slice. */
double warp_spread(const struct warp *warp, size_t slice, double x0, double x1);

#endif
