#include "sparse_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "model/math/fast_math.h"
#include "paper_kernels.h"

static const double LEFT_OUT = 1e-3; /* a tenth of the 1 % that measurements reproduce to */
static const float LEAST_SHARE = 0.05f;
static const double SETTLED = 1e-9, ROUNDING = 1e-12;

bp_status sparse_fit_create(const struct wavelet_plane *plane, struct sparse_fit *out, bp_error *error)
{
	struct sparse_fit fit = {.plane = *plane, .cells = wavelet_field_cells(plane), .coefficients = wavelet_cells(plane)};
	const size_t n = fit.coefficients;

	fit.row_squares = wavelet_squares(plane->kind, plane->rows);
	fit.column_squares = wavelet_squares(plane->kind, plane->columns);
	fit.scratch = malloc(10 * n * sizeof(float));
	if (!fit.row_squares || !fit.column_squares || !fit.scratch) {
		sparse_fit_free(&fit);
		return error_memory(error, 10 * n * sizeof(float));
	}
	fit.field = fit.scratch + 3 * n;
	fit.gradient = fit.scratch + 4 * n;
	fit.inverse = fit.scratch + 5 * n;
	fit.z = fit.scratch + 6 * n;
	fit.direction = fit.scratch + 7 * n;
	fit.image = fit.scratch + 8 * n;
	fit.gain = fit.scratch + 9 * n;
	*out = fit;
	return BP_OK;
}

void sparse_fit_free(struct sparse_fit *fit)
{
	free(fit->row_squares);
	free(fit->column_squares);
	free(fit->scratch);
}

/* out[a][.] = sum over n of square[a][n] in[n][.]; most squares are 0. */
static void squares_apply(const float *square, struct wavelet_axis axis, const float *in, size_t width, float *out)
{
	const struct paper_kernels *kernels = paper_kernels_get();

	memset(out, 0, axis.plane * width * sizeof *out);
	for (size_t a = 0; a < axis.plane; a++)
		for (size_t n = 0; n < axis.field; n++)
			if (square[a * axis.field + n] != 0)
				kernels->add_scaled(square[a * axis.field + n], in + n * width, width, out + a * width);
}

void sparse_fit_energies(struct sparse_fit *fit, struct sparse_target *target)
{
	const struct wavelet_plane *p = &fit->plane;
	const size_t rows = p->rows.field, half = p->columns.field, columns = p->field_columns;
	float *by_column = fit->scratch, *by_row = fit->scratch + fit->coefficients, *energy = target->energy;
	double sum = 0;

	/* The squares of both parts of a mirrored basis function are the same: half of each at both cells. */
	squares_apply(fit->row_squares, p->rows, target->weight, columns, by_row);
	for (size_t r = 0; r < p->rows.plane; r++)
		for (size_t k = 0; k < half; k++)
			by_column[k * p->rows.plane + r] =
				p->mirrored ? 0.5f * (by_row[r * columns + k] + by_row[r * columns + columns - 1 - k]) : by_row[r * columns + k];
	squares_apply(fit->column_squares, p->columns, by_column, p->rows.plane, energy);
	if (p->mirrored)
		memcpy(energy + fit->coefficients / 2, energy, fit->coefficients / 2 * sizeof *energy);
	for (size_t i = 0; i < rows * columns; i++)
		sum += (double)target->weight[i];
	target->least = fmaxf(LEAST_SHARE * (float)(sum / (double)(rows * columns)), 1e-30f);
}

void sparse_fit_gradient(struct sparse_fit *fit, const struct sparse_target *target, const float *x)
{
	wavelet_inverse(&fit->plane, x, fit->field, fit->scratch);
	paper_kernels_get()->residual(target->weight, target->wanted, fit->cells, fit->field);
	wavelet_forward(&fit->plane, fit->field, fit->gradient, fit->scratch);
}

void sparse_fit_gains(const struct sparse_fit *fit, const struct sparse_target *target, const float *x, float *gain)
{
	paper_kernels_get()->gains(x, fit->gradient, target->energy, target->least, fit->coefficients, gain);
}

/* ---- the largest gains ---- */

float gains_keep(const float *gain, size_t n, size_t keep, uint8_t *kept)
{
	enum { SHIFT = 17, BINS = 1 << (31 - SHIFT) }; /* by exponent and the first bits behind it */
	uint32_t count[BINS] = {0}, edge = BINS - 1;

	for (size_t i = 0; i < n; i++)
		count[bits_of_float(gain[i]) >> SHIFT]++;
	while (edge > 1 && count[edge] <= keep)
		keep -= count[edge--];
	for (size_t i = 0; i < n; i++)
		kept[i] = bits_of_float(gain[i]) >> SHIFT >= edge;
	for (size_t i = n, surplus = count[edge] > keep ? count[edge] - keep : 0; surplus > 0;)
		if (bits_of_float(gain[--i]) >> SHIFT == edge) {
			kept[i] = 0;
			surplus--;
		}
	return float_of_bits(edge << SHIFT);
}

/* ---- refinement ---- */

void sparse_fit_refine(struct sparse_fit *fit, const struct sparse_target *target, const uint8_t *kept, uint32_t steps, float *x)
{
	const struct paper_kernels *kernels = paper_kernels_get();
	const size_t n = fit->coefficients;
	bool dropped = false;
	double explained = 0;

	for (size_t i = 0; i < n; i++) {
		fit->inverse[i] = kept[i] ? 1 / (target->energy[i] + target->least) : 0;
		if (!kept[i] && x[i] != 0) {
			x[i] = 0;
			dropped = true;
		}
		explained += (double)(target->energy[i] * x[i] * x[i]);
	}
	if (dropped)
		sparse_fit_gradient(fit, target, x);
	double size = kernels->weigh(fit->inverse, fit->gradient, n, fit->direction);
	const double noise = fmax(SETTLED * size, ROUNDING * explained); /* below it single precision has no direction left to go */
	for (uint32_t step = 0; step < steps && size > noise; step++) {
		wavelet_inverse(&fit->plane, fit->direction, fit->field, fit->scratch);
		const double curvature = kernels->weigh(target->weight, fit->field, fit->cells, fit->field);
		if (!(curvature > 0))
			break;
		const float length = (float)(size / curvature);
		wavelet_forward(&fit->plane, fit->field, fit->image, fit->scratch);
		kernels->add_scaled(length, fit->direction, n, x);
		kernels->add_scaled(-length, fit->image, n, fit->gradient);
		const double next = kernels->weigh(fit->inverse, fit->gradient, n, fit->z);
		kernels->turn((float)(next / size), fit->z, n, fit->direction);
		size = next;
	}
}

float sparse_fit_rounds(struct sparse_fit *fit, const struct sparse_target *target, size_t keep, uint32_t rounds, uint32_t steps,
                        uint8_t *kept, float *x)
{
	float edge = 0;

	sparse_fit_gradient(fit, target, x);
	for (uint32_t round = 0; round < rounds; round++) {
		sparse_fit_gains(fit, target, x, fit->gain);
		edge = gains_keep(fit->gain, fit->coefficients, keep, kept);
		sparse_fit_refine(fit, target, kept, steps, x);
	}
	return edge;
}

/* ---- quantising ---- */

bool sparse_fit_is_one(const struct sparse_fit *fit, const struct sparse_target *target)
{
	double squares = 0;
	size_t count = 0;

	for (size_t i = 0; i < fit->cells; i++)
		if (target->weight[i] > 0) {
			const double d = (double)target->wanted[i] - 1;
			squares += d * d;
			count++;
		}
	return !(squares > LEFT_OUT * LEFT_OUT * (double)count);
}

bp_status sparse_fit_quantise(const struct sparse_fit *fit, const struct sparse_target *target, float unit, const float *x,
                              struct sparse_field *out, bp_error *error)
{
	const size_t n = fit->coefficients;
	double logs = 0, largest = 0;
	uint32_t count = 0;

	*out = (struct sparse_field){.count = 0};
	if (sparse_fit_is_one(fit, target))
		return BP_OK;
	for (size_t i = 0; i < n; i++)
		if (x[i] != 0) {
			logs += fast_log2((double)(target->energy[i] + 1e-6f * target->least) + 1e-300);
			largest = fmax(largest, fabs((double)x[i]));
			count++;
		}
	double step = count ? (double)unit * fast_exp2(-0.5 * logs / (double)count) : 0;
	step = fmax(fmax(step, largest / (PAPER_LEVEL_MAX - 1)), 1e-30);
	const long code = lrint(ceil(256 * fast_log2(step))) + PAPER_STEP_ONE;
	out->step = (uint16_t)(code < PAPER_STEP_LEAST ? PAPER_STEP_LEAST : code > PAPER_STEP_MOST ? PAPER_STEP_MOST : code);
	const float unit_of_levels = paper_step(out->step);
	const bp_status status = sparse_field_alloc(count ? count : 1, out, error);
	if (status)
		return status;
	for (size_t i = 0; i < n; i++) {
		const long level = lrintf(x[i] / unit_of_levels);
		if (!level)
			continue;
		out->index[out->count] = (uint32_t)i;
		out->level[out->count++] = (int32_t)(level > PAPER_LEVEL_MAX    ? PAPER_LEVEL_MAX
		                                     : level < -PAPER_LEVEL_MAX ? -PAPER_LEVEL_MAX
		                                                                : level);
	}
	if (!out->count) { /* a field of zeros is not a field of ones */
		out->index[0] = 0;
		out->level[0] = 1;
		out->step = PAPER_STEP_LEAST;
		out->count = 1;
	}
	return BP_OK;
}
