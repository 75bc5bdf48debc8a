/* spectral_expand_rows.c: tables of models whose rows of phi_d are cut at the horizon, some rows at a time. */
#include "spectral_expand.h"

#include <stdlib.h>

#include "error.h"
#include "spectral_terms.h"
#include "spectrum_rows.h"

/* One more than the highest harmonic with a term. */
static uint32_t harmonics_used(const struct spectral_terms *terms, uint32_t p)
{
	uint32_t most = 0;
	for (uint32_t u = 0; u < 3 * p; u++)
		if (terms->start[u + 1] > terms->start[u] && u % p >= most)
			most = u % p + 1;
	return most;
}

bp_status spectral_expand_rows(const struct spectral_model *model, uint32_t layers, bool half, spectral_block_fn *take,
                               void *user, bp_error *error)
{
	const struct lattice_dims d = model->dims;
	const uint32_t count = d.theta_h * d.theta_d / (half ? 4 : 1);
	const size_t stride = d.phi_d + 15, piece = SPECTRUM_BLOCK * stride;
	struct spectrum_inverse *inverse = NULL;
	struct spectrum_rows *rows = NULL;
	struct spectral_terms terms = {0};
	float *fields = calloc(3 * piece, sizeof *fields);
	bp_status status = fields ? spectrum_inverse_create(d, &inverse, error) : error_memory(error, 3 * piece * sizeof *fields);

	if (!status)
		status = spectral_weights_apply(&model->weights, inverse, error);
	if (!status)
		status = spectral_terms_make(model, inverse, layers, &terms, error);
	if (!status)
		status = spectrum_rows_create(inverse, model->limit, harmonics_used(&terms, d.phi_d), half, &rows, error);
	for (int f = 0; !status && f < 3; f++)
		status = spectrum_rows_field(rows, f, terms.term, terms.start + (size_t)f * d.phi_d, error);
	for (uint32_t r = 0; !status && r < count; r += SPECTRUM_BLOCK) {
		const uint32_t here = count - r < SPECTRUM_BLOCK ? count - r : SPECTRUM_BLOCK;
		for (int f = 0; f < 3; f++)
			spectrum_rows_cells(rows, f, r, here, fields + (size_t)f * piece, stride);
		for (uint32_t n = 0; n < here; n++) {
			struct spectral_block block = {.row = r + n, .rows = 1, .stride = stride, .alone = true};
			spectrum_rows_seen(rows, r + n, &block.column, &block.width);
			for (int f = 0; f < 3; f++)
				block.field[f] = fields + (size_t)f * piece + n * stride + block.column;
			take(user, &block);
		}
	}
	spectral_terms_free(&terms);
	spectrum_rows_free(rows);
	spectrum_inverse_free(inverse);
	free(fields);
	return status;
}
