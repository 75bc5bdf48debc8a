#include "wavelet.h"

#include <stddef.h>
#include <string.h>

enum { TAPS_MAX = 8 };

struct filter {
	unsigned taps;
	double low[TAPS_MAX]; /* the scaling filter h; the wavelet filter is g_k = (-1)^k h_(taps-1-k) */
};

/* sqrt(1/2); ((1 + sqrt 3)/8, (3 + sqrt 3)/8, (3 - sqrt 3)/8, (1 - sqrt 3)/8) sqrt 2 */
static const struct filter FILTERS[] = {
	[WAVELET_HAAR] = {2, {0.70710678118654752, 0.70710678118654752}},
	[WAVELET_DAUBECHIES] = {4, {0.48296291314453414, 0.83651630373780790, 0.22414386804201338, -0.12940952255126038}},
};

struct wavelet_axis wavelet_axis_for(uint32_t n)
{
	struct wavelet_axis axis = {.field = n, .levels = 0};

	while (n >> (axis.levels + 2))
		axis.levels++;
	axis.plane = (n + (1u << axis.levels) - 1) >> axis.levels << axis.levels;
	return axis;
}

/*
 * One level over n rows of `width` values: out row i = sum_k h_k in row (2i + k), out row n/2 + i the same
 * with g; row numbers are modulo n.
 */
static void rows_split(const struct filter *f, const double *restrict in, double *restrict out, size_t n, size_t width)
{
	for (size_t i = 0; i < n / 2; i++) {
		double *restrict low = out + i * width, *restrict high = out + (n / 2 + i) * width;

		memset(low, 0, width * sizeof *low);
		memset(high, 0, width * sizeof *high);
		for (unsigned k = 0; k < f->taps; k++) {
			const double *restrict x = in + (2 * i + k) % n * width;
			const double h = f->low[k], g = k % 2 ? -f->low[f->taps - 1 - k] : f->low[f->taps - 1 - k];

			for (size_t c = 0; c < width; c++) {
				low[c] += h * x[c];
				high[c] += g * x[c];
			}
		}
	}
}

/* The transpose of rows_split, which is its inverse. */
static void rows_join(const struct filter *f, const double *restrict in, double *restrict out, size_t n, size_t width)
{
	memset(out, 0, n * width * sizeof *out);
	for (size_t i = 0; i < n / 2; i++) {
		const double *restrict low = in + i * width, *restrict high = in + (n / 2 + i) * width;

		for (unsigned k = 0; k < f->taps; k++) {
			double *restrict x = out + (2 * i + k) % n * width;
			const double h = f->low[k], g = k % 2 ? -f->low[f->taps - 1 - k] : f->low[f->taps - 1 - k];

			for (size_t c = 0; c < width; c++)
				x[c] += h * low[c] + g * high[c];
		}
	}
}

static void transpose(const double *restrict in, double *restrict out, size_t rows, size_t columns)
{
	enum { TILE = 8 };
	for (size_t r0 = 0; r0 < rows; r0 += TILE)
		for (size_t c0 = 0; c0 < columns; c0 += TILE)
			for (size_t r = r0; r < rows && r < r0 + TILE; r++)
				for (size_t c = c0; c < columns && c < c0 + TILE; c++)
					out[c * rows + r] = in[r * columns + c];
}

/* All levels along the rows' index; the result is in `plane`. */
static void axis_forward(const struct filter *f, struct wavelet_axis axis, size_t width, double *plane, double *scratch)
{
	for (uint32_t l = 0; l < axis.levels; l++) {
		size_t n = axis.plane >> l;
		rows_split(f, plane, scratch, n, width);
		memcpy(plane, scratch, n * width * sizeof *plane);
	}
}

static void axis_inverse(const struct filter *f, struct wavelet_axis axis, size_t width, double *plane, double *scratch)
{
	for (uint32_t l = axis.levels; l-- > 0;) {
		size_t n = axis.plane >> l;
		rows_join(f, plane, scratch, n, width);
		memcpy(plane, scratch, n * width * sizeof *plane);
	}
}

void wavelet_forward(enum wavelet kind, struct wavelet_axis rows, struct wavelet_axis columns, double *plane, double *scratch)
{
	const struct filter *f = &FILTERS[kind];

	axis_forward(f, rows, columns.plane, plane, scratch);
	transpose(plane, scratch, rows.plane, columns.plane);
	axis_forward(f, columns, rows.plane, scratch, plane);
	transpose(scratch, plane, columns.plane, rows.plane);
}

void wavelet_inverse(enum wavelet kind, struct wavelet_axis rows, struct wavelet_axis columns, double *plane, double *scratch)
{
	const struct filter *f = &FILTERS[kind];

	transpose(plane, scratch, rows.plane, columns.plane);
	axis_inverse(f, columns, rows.plane, scratch, plane);
	transpose(scratch, plane, columns.plane, rows.plane);
	axis_inverse(f, rows, columns.plane, plane, scratch);
}
