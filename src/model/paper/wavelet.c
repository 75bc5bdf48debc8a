#include "wavelet.h"

#include <stdlib.h>
#include <string.h>

#include "paper_kernels.h"

/* sqrt(1/2); (1 + sqrt 3, 3 + sqrt 3, 3 - sqrt 3, 1 - sqrt 3) sqrt(2)/8; the wavelet filter is g_k = (-1)^k h_(taps-1-k) */
static const struct wavelet_filter FILTERS[] = {
	[WAVELET_HAAR] = {2, {0.707106781f, 0.707106781f}, {0.707106781f, -0.707106781f}},
	[WAVELET_DAUBECHIES] = {4,
                            {0.482962913f, 0.836516304f, 0.224143868f, -0.129409523f},
                            {-0.129409523f, -0.224143868f, 0.836516304f, -0.482962913f}},
};

struct wavelet_axis wavelet_axis_for(uint32_t n)
{
	struct wavelet_axis axis = {.field = n, .levels = 0};

	while (n >> (axis.levels + 2))
		axis.levels++;
	axis.plane = (n + (1u << axis.levels) - 1) >> axis.levels << axis.levels;
	return axis;
}

struct wavelet_plane wavelet_plane_for(enum wavelet kind, uint32_t rows, uint32_t columns, bool mirrored)
{
	return (struct wavelet_plane){
		.kind = kind,
		.mirrored = mirrored,
		.field_columns = columns,
		.rows = wavelet_axis_for(rows),
		.columns = wavelet_axis_for(mirrored ? (columns + 1) / 2 : columns),
		.parts = mirrored ? 2 : 1,
	};
}

static void transpose(const float *restrict in, float *restrict out, size_t rows, size_t columns)
{
	enum { TILE = 8 };
	for (size_t r0 = 0; r0 < rows; r0 += TILE)
		for (size_t c0 = 0; c0 < columns; c0 += TILE)
			for (size_t r = r0; r < rows && r < r0 + TILE; r++)
				for (size_t c = c0; c < columns && c < c0 + TILE; c++)
					out[c * rows + r] = in[r * columns + c];
}

/* All levels along the rows' index, `in` -> `out`; `in` and `low`, half as large, are overwritten by turns. */
static void axis_forward(enum wavelet kind, struct wavelet_axis axis, size_t width, float *in, float *low, float *out)
{
	const struct paper_kernels *kernels = paper_kernels_get();

	for (uint32_t l = 0; l < axis.levels; l++) {
		const size_t n = axis.plane >> l;
		kernels->wavelet_split(&FILTERS[kind], in, n, width, low, out + n / 2 * width);
		float *t = in;
		in = low;
		low = t;
	}
	memcpy(out, in, (axis.plane >> axis.levels) * width * sizeof *out);
}

/* The inverse: `in` -> `out`, by way of two halves of `low`. */
static void axis_inverse(enum wavelet kind, struct wavelet_axis axis, size_t width, const float *in, float *low, float *out)
{
	const struct paper_kernels *kernels = paper_kernels_get();
	const float *coarse = in;
	float *half[2] = {low, low + axis.plane / 2 * width};

	if (!axis.levels)
		memcpy(out, in, axis.plane * width * sizeof *out);
	for (uint32_t l = axis.levels; l-- > 0;) {
		const size_t n = axis.plane >> l;
		float *to = l ? half[l % 2] : out;
		kernels->wavelet_join(&FILTERS[kind], coarse, in + n / 2 * width, n, width, to);
		coarse = to;
	}
}

void wavelet_forward(const struct wavelet_plane *p, const float *field, float *coefficient, float *scratch)
{
	const size_t width = (size_t)p->columns.plane * p->parts, cells = wavelet_cells(p),
				 part = (size_t)p->columns.plane * p->rows.plane;
	float *a = scratch, *b = scratch + cells, *low = scratch + 2 * cells;

	memset(a, 0, cells * sizeof *a);
	for (size_t r = 0; r < p->rows.field; r++) {
		const float *from = field + r * p->field_columns;
		if (p->mirrored)
			paper_kernels_get()->mirror_split(from, p->field_columns, a + r * width, a + r * width + p->columns.plane);
		else
			memcpy(a + r * width, from, p->field_columns * sizeof *a);
	}
	axis_forward(p->kind, p->rows, width, a, low, b);
	transpose(b, a, p->rows.plane, width);
	for (uint32_t q = 0; q < p->parts; q++)
		axis_forward(p->kind, p->columns, p->rows.plane, a + q * part, low, coefficient + q * part);
}

void wavelet_inverse(const struct wavelet_plane *p, const float *coefficient, float *field, float *scratch)
{
	const size_t width = (size_t)p->columns.plane * p->parts, cells = wavelet_cells(p),
				 part = (size_t)p->columns.plane * p->rows.plane;
	float *a = scratch, *b = scratch + cells, *low = scratch + 2 * cells;

	for (uint32_t q = 0; q < p->parts; q++)
		axis_inverse(p->kind, p->columns, p->rows.plane, coefficient + q * part, low, a + q * part);
	transpose(a, b, width, p->rows.plane);
	axis_inverse(p->kind, p->rows, width, b, low, a);
	for (size_t r = 0; r < p->rows.field; r++) {
		float *to = field + r * p->field_columns;
		if (p->mirrored)
			paper_kernels_get()->mirror_join(a + r * width, a + r * width + p->columns.plane, p->field_columns, to);
		else
			memcpy(to, a + r * width, p->field_columns * sizeof *to);
	}
}

float *wavelet_squares(enum wavelet kind, struct wavelet_axis axis)
{
	const size_t n = axis.field, cells = n * axis.plane;
	float *in = calloc(3 * cells, sizeof *in), *out = malloc(cells * sizeof *out);

	if (in && out) {
		for (size_t i = 0; i < n; i++)
			in[i * n + i] = 1;
		axis_forward(kind, axis, n, in, in + cells, out);
		for (size_t i = 0; i < cells; i++)
			out[i] *= out[i];
	} else {
		free(out);
		out = NULL;
	}
	free(in);
	return out;
}
