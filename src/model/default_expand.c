/* default_expand.c: coefficients become a table, block by block of phi_d; the inverse of default_fit.c. */
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

bp_status default_expand(const struct model *model, uint32_t layers, struct expansion *out, bp_error *error)
{
	const struct kernels *kernels = kernels_get();
	const struct default_model *m = model->log_density;
	const struct lattice_dims d = model->dims;
	const size_t rows = (size_t)d.theta_h * d.theta_d, cells = rows * SPECTRUM_BLOCK;
	struct spectrum_inverse *inverse = NULL;
	struct default_terms terms = {0};
	const float most = default_most(m->unit);
	float *planes = memory_alloc(3 * cells * sizeof *planes);
	bp_status status = planes ? spectrum_inverse_create(d, &inverse, error) : error_memory(error, 3 * cells * sizeof *planes);

	if (!status)
		status = default_terms_make(m, inverse, layers, &terms, error);
	for (uint32_t k = 0; !status && k < d.phi_d; k += SPECTRUM_BLOCK) {
		const float *const field[3] = {planes, planes + cells, planes + 2 * cells};
		float *const rgb[3] = {out->rgb[0] + k, out->rgb[1] + k, out->rgb[2] + k};
		for (size_t f = 0; f < 3; f++)
			spectrum_inverse_block(inverse, terms.term, terms.start + f * d.phi_d, k, planes + f * cells);
		const size_t width = d.phi_d - k < SPECTRUM_BLOCK ? d.phi_d - k : SPECTRUM_BLOCK;
		kernels->default_values(field, rows, width, SPECTRUM_BLOCK, m->base, (const float(*)[3])m->rotation, most, rgb, d.phi_d);
	}
	out->unit = m->unit;
	default_terms_free(&terms);
	spectrum_inverse_free(inverse);
	free(planes);
	return status;
}
