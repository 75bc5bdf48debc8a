/* default_expand.c: coefficients become a table, block by block of phi_d; the inverse of default_fit.c. */
#include "default_expand.h"

#include <math.h>
#include <stdlib.h>

#include "../error.h"
#include "../memory.h"
#include "default_terms.h"
#include "kernels.h"

float default_most(double unit)
{
	int exponent;
	frexp(unit, &exponent);
	return exponent > 1011 - 40 ? (float)(1011 - exponent) : 40;
}

bp_status default_expand_blocks(const struct model *model, uint32_t layers, default_block_fn *take, void *user, bp_error *error)
{
	const struct lattice_dims d = model->dims;
	const size_t rows = (size_t)d.theta_h * d.theta_d, cells = rows * SPECTRUM_BLOCK;
	struct spectrum_inverse *inverse = NULL;
	struct default_terms terms = {0};
	float *planes = memory_alloc(3 * cells * sizeof *planes);
	bp_status status = planes ? spectrum_inverse_create(d, &inverse, error) : error_memory(error, 3 * cells * sizeof *planes);

	if (!status)
		status = default_terms_make(model->log_density, inverse, layers, &terms, error);
	for (uint32_t k = 0; !status && k < d.phi_d; k += SPECTRUM_BLOCK) {
		const struct default_block block = {
			.field = {planes, planes + cells, planes + 2 * cells},
			.rows = rows, .column = k, .width = d.phi_d - k < SPECTRUM_BLOCK ? d.phi_d - k : SPECTRUM_BLOCK, .stride = SPECTRUM_BLOCK,
		};
		for (size_t f = 0; f < 3; f++)
			spectrum_inverse_block(inverse, terms.term, terms.start + f * d.phi_d, k, planes + f * cells);
		take(user, &block);
	}
	default_terms_free(&terms);
	spectrum_inverse_free(inverse);
	free(planes);
	return status;
}

struct values_target {
	const struct default_model *model;
	const struct expansion *out;
};

static void values_take(void *user, const struct default_block *block)
{
	const struct values_target *target = user;
	const struct default_model *m = target->model;
	const size_t p = target->out->dims.phi_d, at = block->row * p + block->column;
	float *const rgb[3] = {target->out->rgb[0] + at, target->out->rgb[1] + at, target->out->rgb[2] + at};

	kernels_get()->default_values(block->field, block->rows, block->width, block->stride, m->base, (const float(*)[3])m->rotation,
	                              default_most(m->unit), rgb, p);
}

bp_status default_expand(const struct model *model, uint32_t layers, struct expansion *out, bp_error *error)
{
	struct values_target target = {model->log_density, out};
	out->unit = model->log_density->unit;
	return default_expand_blocks(model, layers, values_take, &target, error);
}

bp_status default_expand_half(const struct model *model, uint32_t layers, struct expansion *out, bp_error *error)
{
	struct values_target target = {model->log_density, out};
	out->unit = model->log_density->unit;
	return default_expand_half_blocks(model, layers, values_take, &target, error);
}
