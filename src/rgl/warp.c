#include "warp.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "grid.h"

int warp_alloc(struct warp *warp, size_t slices, size_t height, size_t width)
{
	const size_t nodes = slices * height * width;
	*warp = (struct warp){.slices = slices, .height = height, .width = width};
	warp->density = malloc(nodes * sizeof(float));
	warp->along_row = malloc(nodes * sizeof(float));
	warp->along_column = malloc(slices * height * sizeof(float));
	return warp->density && warp->along_row && warp->along_column;
}

void warp_free(struct warp *warp)
{
	free(warp->density);
	free(warp->along_row);
	free(warp->along_column);
	*warp = (struct warp){0};
}

/* Integral of a row up to node x, by trapezia. */
static double row_step(const double *row, size_t x) { return x ? 0.5 * (row[x - 1] + row[x]) : 0; }

static double row_integral(const double *row, size_t width)
{
	double sum = 0;
	for (size_t x = 1; x < width; x++)
		sum += row_step(row, x);
	return sum;
}

int warp_fill(struct warp *warp, size_t slice, double *values, size_t *at)
{
	const size_t height = warp->height, width = warp->width;
	double total = 0, before = 0, column = 0;
	for (size_t n = 0; n < height * width; n++)
		if (!(values[n] >= 0 && values[n] <= FLT_MAX)) {
			*at = n;
			return -1;
		}
	for (size_t y = 0; y < height; y++) {
		const double row = row_integral(values + y * width, width);
		total += y ? 0.5 * (before + row) : 0;
		before = row;
	}
	if (!(total > FLT_MIN && total <= FLT_MAX))
		return -2;
	for (size_t n = 0; n < height * width; n++)
		values[n] /= total;
	before = 0;
	for (size_t y = 0; y < height; y++) {
		const size_t start = (slice * height + y) * width;
		double row = 0;
		for (size_t x = 0; x < width; x++) {
			row += row_step(values + y * width, x);
			warp->density[start + x] = (float)values[y * width + x];
			warp->along_row[start + x] = (float)row;
		}
		column += y ? 0.5 * (before + row) : 0;
		warp->along_column[slice * height + y] = (float)column;
		before = row;
	}
	return 0;
}

static double mix(double a, double b, double t) { return a + t * (b - a); }

static double unit(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

void warp_invert(const struct warp *warp, struct warp_place place, double x, double y, double *sx, double *sy)
{
	const size_t height = warp->height, width = warp->width, slice = place.slice, more = place.next > 0;
	double fx, fy;
	const size_t ix = grid_node(x, width, &fx), iy = grid_node(y, height, &fy);
	const size_t corner = (slice * height + iy) * width + ix, row_end = (slice * height + iy) * width + width - 1;
	const size_t step = more * height * width; /* to the same node of the next slice */
	const float *d = warp->density + corner, *c = warp->along_row;

	/* in the two rows around y: density at x, integral up to x, integral of all */
	double density[2], part[2], whole[2];
	for (size_t r = 0; r < 2; r++) {
		const float *node = d + r * width;
		const double left = mix((double)node[0], (double)node[step], place.next);
		const double right = mix((double)node[1], (double)node[step + 1], place.next);
		const size_t here = corner + r * width, end = row_end + r * width;
		density[r] = fx * (left + 0.5 * fx * (right - left));
		part[r] = mix((double)c[here], (double)c[here + step], place.next);
		whole[r] = mix((double)c[end], (double)c[end + step], place.next);
	}
	const double row = mix(whole[0], whole[1], fy);
	const float *column = warp->along_column + slice * height + iy;
	*sx = row > 0 ? unit((mix(density[0], density[1], fy) + mix(part[0], part[1], fy)) / row) : 0;
	*sy = unit(mix((double)column[0], (double)column[more * height], place.next) +
	           fy * (whole[0] + 0.5 * fy * (whole[1] - whole[0])));
}

double warp_spread(const struct warp *warp, size_t slice, double x0, double x1)
{
	double most = 0;
	for (size_t y = 0; y < warp->height; y++) {
		const double at = (double)y / (double)(warp->height - 1);
		double from, to, sy;
		warp_invert(warp, (struct warp_place){slice, 0}, x0, at, &from, &sy);
		warp_invert(warp, (struct warp_place){slice, 0}, x1, at, &to, &sy);
		most = fmax(most, to - from);
	}
	return most;
}
