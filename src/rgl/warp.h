/*
 * warp.h: densities over the unit square, one to each angle of incidence, and the square stretched by them.
 *
 * A slice is a grid of height x width values at the nodes of the square, bilinear between them; x = u_m runs along a row, y = v_m
 * from row to row. A point (x, y) belongs to the point (s, t):
 *
 *     t = mass of the rows below y, of the slice's whole: the marginal distribution function, quadratic in y between two rows
 *     s = mass of the row at y before x, of that row's whole: the conditional one, quadratic in x between two nodes
 *
 * so that (s, t) is uniform where (x, y) follows the density. Between two angles the densities and their integrals are
 * interpolated linearly. (Dupuy and Jakob 2018, section 4: measurements follow the visible normals.)
 */
#ifndef RGL_WARP_H
#define RGL_WARP_H

#include <stddef.h>

struct warp {
	size_t slices, height, width; /* height and width at least 2 */
	double across, up;            /* a length of 1 is so many cells along a row, so many rows */
	float *density;               /* [slices][height][width], of mass 1 a slice */
	double *along_row;            /* [slices][height][width]: integral from the row's beginning to the node */
	double *along_column;         /* [slices][height]: mass of all rows before */
};

/*
 * No values yet. across = width - 1, up = height - 1: densities over the unit square; 1 and 1: over a grid of spacing 1. False:
 * no memory. warp_free in any case.
 */
int warp_alloc(struct warp *warp, size_t slices, size_t height, size_t width, double across, double up);
void warp_free(struct warp *warp); /* a zeroed struct is allowed */

/*
 * Fills one slice from height x width values. Returns 0; -1 where one is negative, NaN or infinite, and *at is which; -2 where
 * their integral is 0 or beyond what float holds.
 */
int warp_fill(struct warp *warp, size_t slice, const double *values, size_t *at);

/* Rounds all integrals to floats: as the database's readers hold them. */
void warp_round(struct warp *warp);

/* Where a point is between two angles: of the slice, and of the next one with the weight `next`, 0 to 1 (0: maybe none). */
struct warp_place {
	size_t slice;
	double next;
};

/* (s, t) -> (x, y) by one angle. */
void warp_forward(const struct warp *warp, size_t slice, const double at[2], double out[2]);

/* (x, y) -> (s, t), both in the unit square: the other way round. */
void warp_inverse(const struct warp *warp, struct warp_place place, const double at[2], double out[2]);

/* The most that s grows from x0 to x1 along any row of a slice. */
double warp_spread(const struct warp *warp, size_t slice, double x0, double x1);

#endif
