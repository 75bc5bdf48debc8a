#include "lobe_sample.h"

#include <stdlib.h>

#include "error.h"

/* cos 80 degrees: Ngan et al. leave out what lies beyond, where measurements are unreliable. */
static const double COSINE_LIMIT = 0.17364817766693036;

/* In 1/sr, as in the log RMSE: darker is not told apart. */
static const double RELATIVE_OFFSET = 1e-3;

/* The measure along theta_h of cell i: the integral of sin over [i^2, (i + 1)^2] / H^2 pi/2. */
static double measure_h(uint32_t i, uint32_t extent)
{
	double low = (double)i / extent, high = (i + 1.0) / extent;

	return cos(low * low * M_PI_2) - cos(high * high * M_PI_2);
}

/* ... of 4 cos sin along theta_d. */
static double measure_d(uint32_t j, uint32_t extent)
{
	double low = sin((double)j / extent * M_PI_2), high = sin((j + 1.0) / extent * M_PI_2);

	return 2 * (high * high - low * low);
}

bp_status lobe_sample_take(const struct lattice *lattice, uint32_t stride_d, uint32_t stride_p, struct lobe_sample *out,
                           bp_error *error)
{
	const struct lattice_dims dims = lattice->dims;
	size_t most = (size_t)dims.theta_h * ((dims.theta_d + stride_d - 1) / stride_d) * ((dims.phi_d + stride_p - 1) / stride_p);
	size_t bytes = most * (sizeof(struct cell_angles) + 4 * sizeof(double) + sizeof(uint32_t));
	struct lattice_cosines tables;
	struct lobe_sample sample = {.unit = 0};
	double weight_sum = 0;

	lattice_centres(dims, &tables);
	sample.angles = malloc(bytes);
	if (!sample.angles)
		return error_memory(error, bytes);
	sample.weight = (double *)(void *)(sample.angles + most);
	for (int c = 0; c < 3; c++)
		sample.rgb[c] = sample.weight + (size_t)(c + 1) * most;
	sample.cell = (uint32_t *)(void *)(sample.weight + 4 * most);
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j += stride_d)
			for (uint32_t k = 0; k < dims.phi_d; k += stride_p) {
				size_t cell = lattice_index(dims, i, j, k), n = sample.count;
				struct cell_angles a = cell_angles_at(&tables, i, j, k);
				if (!lattice->valid[cell] || a.cos_i < COSINE_LIMIT || a.cos_o < COSINE_LIMIT)
					continue;
				sample.angles[n] = a;
				sample.cell[n] = (uint32_t)cell;
				sample.weight[n] =
					measure_h(i, dims.theta_h) * measure_d(j, dims.theta_d) * 0.5 * (a.cos_i * a.cos_i + a.cos_o * a.cos_o);
				weight_sum += sample.weight[n];
				for (int c = 0; c < 3; c++) {
					sample.rgb[c][n] = lattice->rgb[c][cell];
					sample.unit = fmax(sample.unit, sample.rgb[c][n]);
				}
				sample.count++;
			}
	if (!sample.count) {
		free(sample.angles);
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
		                 "no valid cell within 80 degrees of the normal: nothing to fit an analytic model to");
	}
	if (!(sample.unit > 0))
		sample.unit = 1;
	for (size_t n = 0; n < sample.count; n++) {
		sample.weight[n] /= weight_sum;
		for (int c = 0; c < 3; c++)
			sample.rgb[c][n] /= sample.unit;
	}
	*out = sample;
	return BP_OK;
}

bp_status lobe_sample_make_relative(struct lobe_sample *sample, bp_error *error)
{
	const double offset = RELATIVE_OFFSET / sample->unit;

	sample->relative = malloc(3 * sample->count * sizeof *sample->relative);
	if (!sample->relative)
		return error_memory(error, 3 * sample->count * sizeof *sample->relative);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < sample->count; n++) {
			const double b = sample->rgb[c][n] + offset;
			sample->relative[(size_t)c * sample->count + n] = sample->weight[n] / (b * b);
		}
	return BP_OK;
}

double nonnegative_pair(double pp, double pl, double ll, double py, double ly, double *a, double *b)
{
	double det = pp * ll - pl * pl;
	bool independent = det > 1e-13 * pp * ll;

	*a = independent ? (py * ll - ly * pl) / det : 0;
	*b = independent ? (ly * pp - py * pl) / det : 0;
	if (!independent || *a < 0 || *b < 0) { /* the better edge of the quadrant */
		double only_a = fmax(0, py / pp), only_b = ll > 0 ? fmax(0, ly / ll) : 0;
		bool first = py * only_a >= ly * only_b;
		*a = first ? only_a : 0;
		*b = first ? 0 : only_b;
	}
	return 2 * (*a * py + *b * ly) - *a * *a * pp - 2 * *a * *b * pl - *b * *b * ll;
}

void lobe_sample_free(struct lobe_sample *sample)
{
	free(sample->angles);
	free(sample->relative);
}
