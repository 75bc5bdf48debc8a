#include "warp.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "grid.h"

int warp_alloc(struct warp *warp, size_t slices, size_t height, size_t width, double across, double up)
{
	const size_t nodes = slices * height * width;
	*warp = (struct warp){.slices = slices, .height = height, .width = width, .across = across, .up = up};
	warp->density = malloc(nodes * sizeof *warp->density);
	warp->along_row = malloc(nodes * sizeof *warp->along_row);
	warp->along_column = malloc(slices * height * sizeof *warp->along_column);
	return warp->density && warp->along_row && warp->along_column;
}

void warp_free(struct warp *warp)
{
	free(warp->density);
	free(warp->along_row);
	free(warp->along_column);
	*warp = (struct warp){0};
}

int warp_fill(struct warp *warp, size_t slice, const double *values, size_t *at)
{
	const size_t height = warp->height, width = warp->width, nodes = height * width;
	float *density = warp->density + slice * nodes;
	double *rows = warp->along_row + slice * nodes, *column = warp->along_column + slice * height;
	for (size_t n = 0; n < nodes; n++)
		if (!(values[n] >= 0 && values[n] <= FLT_MAX)) {
			*at = n;
			return -1;
		}
	for (size_t y = 0; y < height; y++) {
		double *row = rows + y * width;
		row[0] = 0;
		for (size_t x = 1; x < width; x++)
			row[x] = row[x - 1] + (values[y * width + x - 1] + values[y * width + x]) / (2 * warp->across);
		column[y] = y ? column[y - 1] + (row[-1] + row[width - 1]) / (2 * warp->up) : 0; /* row[-1]: all of the row before */
	}
	const double total = column[height - 1];
	if (!(total > FLT_MIN && total <= FLT_MAX))
		return -2;
	const double scale = 1 / total;
	for (size_t n = 0; n < nodes; n++) {
		density[n] = (float)(values[n] * scale);
		rows[n] *= scale;
	}
	for (size_t y = 0; y < height; y++)
		column[y] *= scale;
	return 0;
}

void warp_round(struct warp *warp)
{
	for (size_t n = 0; n < warp->slices * warp->height * warp->width; n++)
		warp->along_row[n] = (double)(float)warp->along_row[n];
	for (size_t n = 0; n < warp->slices * warp->height; n++)
		warp->along_column[n] = (double)(float)warp->along_column[n];
}

static double mix(double a, double b, double t) { return a + t * (b - a); }

static double unit(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

/* The integral from 0 to t of a line that goes from a to b within a unit. */
static double segment(double t, double a, double b) { return t * (a + 0.5 * t * (b - a)); }

/* Where that integral has the value `mass`, in [0, 1]. */
static double segment_find(double mass, double a, double b)
{
	const double sum = a + sqrt(fmax(0, a * a + 2 * mass * (b - a)));
	return sum > 0 ? unit(2 * mass / sum) : 0;
}

void warp_forward(const struct warp *warp, size_t slice, const double at[2], double out[2])
{
	const size_t height = warp->height, width = warp->width;
	const double *column = warp->along_column + slice * height;
	size_t x = 0, y = 0;
	while (y + 2 < height && column[y + 1] <= at[1])
		y++;
	const size_t row = (slice * height + y) * width;
	const double *low = warp->along_row + row, *high = low + width;
	const double fy = segment_find((at[1] - column[y]) * warp->up, low[width - 1], high[width - 1]);
	const double part = at[0] * mix(low[width - 1], high[width - 1], fy);
	while (x + 2 < width && mix(low[x + 1], high[x + 1], fy) <= part)
		x++;
	const float *d = warp->density + row + x;
	const double left = mix((double)d[0], (double)d[width], fy), right = mix((double)d[1], (double)d[width + 1], fy);
	const double fx = segment_find((part - mix(low[x], high[x], fy)) * warp->across, left, right);
	out[0] = ((double)x + fx) / (double)(width - 1);
	out[1] = ((double)y + fy) / (double)(height - 1);
}

void warp_inverse(const struct warp *warp, struct warp_place place, const double at[2], double out[2])
{
	const size_t height = warp->height, width = warp->width;
	const size_t step = place.next > 0 ? height : 0; /* to the same row of the next slice */
	double fx, fy;
	const size_t x = grid_node(at[0], width, &fx), y = grid_node(at[1], height, &fy);

	/* in the two rows around y: mass before the node, from there to x, and of all */
	double before[2], part[2], whole[2];
	for (size_t r = 0; r < 2; r++) {
		const size_t row = (place.slice * height + y + r) * width, next = step * width;
		const float *d = warp->density + row + x;
		const double *sum = warp->along_row + row;
		const double left = mix((double)d[0], (double)d[next], place.next);
		const double right = mix((double)d[1], (double)d[next + 1], place.next);
		part[r] = segment(fx, left, right) / warp->across;
		before[r] = mix(sum[x], sum[x + next], place.next);
		whole[r] = mix(sum[width - 1], sum[width - 1 + next], place.next);
	}
	const double row = mix(whole[0], whole[1], fy);
	const double *column = warp->along_column + place.slice * height + y;
	out[0] = row > 0 ? unit((mix(part[0], part[1], fy) + mix(before[0], before[1], fy)) / row) : 0;
	out[1] = unit(mix(column[0], column[step], place.next) + segment(fy, whole[0], whole[1]) / warp->up);
}

double warp_spread(const struct warp *warp, size_t slice, double x0, double x1)
{
	double most = 0;
	for (size_t y = 0; y < warp->height; y++) {
		const double at = (double)y / (double)(warp->height - 1);
		double from[2], to[2];
		warp_inverse(warp, (struct warp_place){slice, 0}, (double[]){x0, at}, from);
		warp_inverse(warp, (struct warp_place){slice, 0}, (double[]){x1, at}, to);
		most = fmax(most, to[0] - from[0]);
	}
	return most;
}
