/* spectral_expand.c: coefficients become a table, block by block of phi_d; the inverse of spectral_fit.c. */
#include "spectral_expand.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "spectral_terms.h"
#include "spectral_kernels.h"

/* The largest logarithm that is decoded: 40, less where unit 2^40 would be above 2^1011. */
static float most_of(double unit)
{
	int exponent;
	frexp(unit, &exponent);
	return exponent > 1011 - 40 ? (float)(1011 - exponent) : 40;
}

bp_status spectral_expand_blocks(const struct spectral_model *model, uint32_t layers, spectral_block_fn *take, void *user,
                                 bp_error *error)
{
	const struct lattice_dims d = model->dims;
	const size_t rows = (size_t)d.theta_h * d.theta_d, cells = rows * SPECTRUM_BLOCK;
	struct spectrum_inverse *inverse = NULL;
	struct spectral_terms terms = {0};
	float *planes = memory_alloc(3 * cells * sizeof *planes);
	bp_status status = planes ? spectrum_inverse_create(d, &inverse, error) : error_memory(error, 3 * cells * sizeof *planes);

	if (!status)
		status = spectral_weights_apply(&model->weights, inverse, error);
	if (!status)
		status = spectral_terms_make(model, inverse, layers, &terms, error);
	for (uint32_t k = 0; !status && k < d.phi_d; k += SPECTRUM_BLOCK) {
		const struct spectral_block block = {
			.field = {planes, planes + cells, planes + 2 * cells},
			.rows = rows,
			.column = k,
			.width = d.phi_d - k < SPECTRUM_BLOCK ? d.phi_d - k : SPECTRUM_BLOCK,
			.stride = SPECTRUM_BLOCK,
		};
		for (size_t f = 0; f < 3; f++)
			spectrum_inverse_block(inverse, terms.term, terms.start + f * d.phi_d, k, planes + f * cells);
		take(user, &block);
	}
	spectral_terms_free(&terms);
	spectrum_inverse_free(inverse);
	free(planes);
	return status;
}

static bp_status expand(const struct spectral_model *model, uint32_t layers, bool half, spectral_block_fn *take, void *user,
                        bp_error *error)
{
	if (model->coefficient[0])
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "a model that was fitted has no levels; its record has");
	if (model->limit > 0)
		return spectral_expand_rows(model, layers, half, take, user, error);
	return (half ? spectral_expand_half_blocks : spectral_expand_blocks)(model, layers, take, user, error);
}

/* `bytes` bytes of values of `size` bytes, each as the one at `value`; twice as many from step to step. */
static void repeat(uint8_t *to, const uint8_t *value, size_t size, size_t bytes)
{
	for (size_t done = 0, here = size; done < bytes; done += here) {
		here = done ? done : size;
		here = here < bytes - done ? here : bytes - done;
		memcpy(to + done, done ? to : value, here);
	}
}

/* The cells on either side of a block that is alone, in a row of p values of `size` bytes. */
static void sides_fill(const struct spectral_block *block, void *row, size_t size, uint32_t p)
{
	const uint32_t end = block->column + block->width;
	uint8_t *own = (uint8_t *)row + block->column * size, *behind = (uint8_t *)row + end * size;

	repeat(row, own, size, block->column * size);
	repeat(behind, behind - size, size, (p - end) * size);
}

struct values_target {
	const struct spectral_model *model;
	const struct expansion *out;
};

static void values_take(void *user, const struct spectral_block *block)
{
	const struct values_target *target = user;
	const struct spectral_model *m = target->model;
	const size_t p = target->out->dims.phi_d, at = block->row * p + block->column;
	float *const rgb[3] = {target->out->rgb[0] + at, target->out->rgb[1] + at, target->out->rgb[2] + at};

	spectral_kernels_get()->spectral_values(block->field, block->rows, block->width, block->stride, m->base,
	                                        (const float(*)[3])m->rotation, most_of(m->unit), rgb, p);
	for (int c = 0; c < 3 && block->alone; c++)
		sides_fill(block, target->out->rgb[c] + block->row * p, sizeof(float), (uint32_t)p);
}

bp_status spectral_expand(const struct spectral_model *model, uint32_t layers, bool half, struct expansion *out, bp_error *error)
{
	struct values_target target = {model, out};
	out->unit = model->unit;
	return expand(model, layers, half, values_take, &target, error);
}

struct codes_target {
	const struct spectral_model *model;
	int channels;
	uint16_t *out;
	size_t stride;
	uint32_t cells; /* of a row */
};

static void codes_take(void *user, const struct spectral_block *block)
{
	const struct codes_target *target = user;
	const struct spectral_model *m = target->model;
	uint16_t *row = target->out + block->row * target->stride, *out = row + (size_t)block->column * (size_t)target->channels;

	spectral_kernels_get()->spectral_codes(block->field, block->rows, block->width, block->stride, m->base,
	                                       (const float(*)[3])m->rotation, most_of(m->unit), target->channels, out,
	                                       target->stride);
	if (block->alone)
		sides_fill(block, row, (size_t)target->channels * sizeof *row, target->cells);
}

bp_status spectral_expand_codes(const struct spectral_model *model, uint32_t layers, bool half, int channels, uint16_t *out,
                                size_t stride, bp_error *error)
{
	struct codes_target target = {model, channels, out, stride, model->dims.phi_d / (half ? 2 : 1)};
	return expand(model, layers, half, codes_take, &target, error);
}
