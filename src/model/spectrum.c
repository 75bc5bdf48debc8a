#include "spectrum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "kernels.h"

enum { COLUMNS_STEP = 16 }; /* cosine_product works on so many columns at once */

struct spectrum {
	struct lattice_dims dims;
	uint32_t levels;
	size_t even, odd;               /* harmonics of either kind; half rows of the table have as many cells */
	size_t even_columns, odd_columns; /* the same rounded up to COLUMNS_STEP */
	float *to_even, *to_odd;        /* [cell][harmonic] */
	float *folded, *product;        /* theta_d rows of even_columns + odd_columns values each */
	float *scratch;                 /* for the wavelets */
};

uint32_t spectrum_levels(uint32_t theta_h, uint32_t theta_d)
{
	uint32_t n = theta_h < theta_d ? theta_h : theta_d, levels = 0;
	while ((n + 1) / 2 >= 8) {
		n = (n + 1) / 2;
		levels++;
	}
	return levels;
}

/* From the first quadrant only, so that equal angles give equal values. */
double spectrum_cosine(uint64_t a, uint32_t p)
{
	double c, s;
	a %= 4 * (uint64_t)p;
	if (a > 2 * (uint64_t)p)
		a = 4 * (uint64_t)p - a;
	const int negative = a > p;
	if (negative)
		a = 2 * (uint64_t)p - a;
	quarter_cos_sin((double)a / p, &c, &s);
	return negative ? -c : c;
}

static void tables_fill(struct spectrum *t)
{
	const uint32_t p = t->dims.phi_d;
	for (uint32_t m = 0; m < p; m++) {
		const double scale = sqrt((m ? 2.0 : 1.0) / p);
		float *to = m % 2 ? t->to_odd : t->to_even;
		const size_t columns = m % 2 ? t->odd_columns : t->even_columns, cells = m % 2 ? t->odd : t->even;
		for (uint32_t k = 0; k < cells; k++) {
			/* The cell in the middle of an odd row is its own mirror image; the fold below does not double it. */
			to[k * columns + m / 2] = (float)(scale * spectrum_cosine((uint64_t)m * (2 * k + 1), p));
		}
	}
}

bp_status spectrum_create(struct lattice_dims dims, struct spectrum **out, bp_error *error)
{
	const size_t longest = dims.theta_h > dims.theta_d ? dims.theta_h : dims.theta_d;
	struct spectrum *t = calloc(1, sizeof *t);

	if (!t)
		return error_memory(error, sizeof *t);
	t->dims = dims;
	t->levels = spectrum_levels(dims.theta_h, dims.theta_d);
	t->even = (dims.phi_d + 1) / 2;
	t->odd = dims.phi_d / 2;
	t->even_columns = (t->even + COLUMNS_STEP - 1) / COLUMNS_STEP * COLUMNS_STEP;
	t->odd_columns = (t->odd + COLUMNS_STEP - 1) / COLUMNS_STEP * COLUMNS_STEP;
	const size_t columns = t->even_columns + t->odd_columns;
	t->to_even = calloc(t->even * t->even_columns, sizeof(float));
	t->to_odd = calloc(t->odd * t->odd_columns, sizeof(float));
	t->folded = malloc(dims.theta_d * columns * sizeof(float));
	t->product = malloc(dims.theta_d * columns * sizeof(float));
	t->scratch = malloc(12 * longest * sizeof(float));
	if (!t->to_even || !t->to_odd || !t->folded || !t->product || !t->scratch) {
		spectrum_free(t);
		return error_memory(error, dims.theta_d * columns * sizeof(float));
	}
	tables_fill(t);
	*out = t;
	return BP_OK;
}

void spectrum_free(struct spectrum *t)
{
	if (!t)
		return;
	free(t->to_even);
	free(t->to_odd);
	free(t->folded);
	free(t->product);
	free(t->scratch);
	free(t);
}

/* One slice [theta_d][phi_d] becomes [theta_d][lane] in place. */
static void slice_forward(struct spectrum *t, float *slice, float base)
{
	const struct kernels *kernels = kernels_get();
	const size_t p = t->dims.phi_d, rows = t->dims.theta_d, even = t->even, odd = t->odd;
	float *sum = t->folded, *difference = t->folded + rows * t->even_columns;

	for (size_t j = 0; j < rows; j++) {
		const float *x = slice + j * p;
		float *e = sum + j * even, *o = difference + j * odd;
		for (size_t k = 0; k < odd; k++) {
			e[k] = (x[k] - base) + (x[p - 1 - k] - base);
			o[k] = x[k] - x[p - 1 - k];
		}
		if (even > odd)
			e[odd] = x[odd] - base;
	}
	kernels->cosine_product(sum, even, rows, even, t->to_even, t->even_columns, t->product, t->even_columns);
	for (size_t j = 0; j < rows; j++)
		memcpy(slice + j * p, t->product + j * t->even_columns, even * sizeof(float));
	kernels->cosine_product(difference, odd, rows, odd, t->to_odd, t->odd_columns, t->product, t->odd_columns);
	for (size_t j = 0; j < rows; j++)
		memcpy(slice + j * p + even, t->product + j * t->odd_columns, odd * sizeof(float));
}

void spectrum_forward(struct spectrum *t, float *table, float base)
{
	const struct kernels *kernels = kernels_get();
	const size_t p = t->dims.phi_d, slice = t->dims.theta_d * p;
	size_t rows = t->dims.theta_h, columns = t->dims.theta_d;

	for (size_t i = 0; i < t->dims.theta_h; i++)
		slice_forward(t, table + i * slice, base);
	for (uint32_t l = 0; l < t->levels; l++) {
		for (size_t i = 0; i < rows; i++)
			kernels->cdf97_forward(table + i * slice, columns, p, p, t->scratch);
		kernels->cdf97_forward(table, rows, slice, columns * p, t->scratch);
		rows = (rows + 1) / 2;
		columns = (columns + 1) / 2;
	}
}
