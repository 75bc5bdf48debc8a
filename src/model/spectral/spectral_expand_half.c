/*
 * spectral_expand_half.c: every second value of the table, without computing the others: what a preview needs.
 *
 * A preview's layers use few harmonics of each field, so here the wavelets come first, on blocks of harmonics instead of
 * blocks of cells; then the cosines and exponentials, on a quarter and an eighth.
 */
#include "spectral_expand.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "spectral_terms.h"
#include "spectral_kernels.h"

enum {
	COLUMNS_STEP = 16,
	ROWS_STEP = 16
}; /* cosine_product works on so many columns at once; rows whose fields stay in the nearest cache */

/* One field's harmonics in use, and their values at the rows that are wanted. */
struct narrow {
	uint32_t *harmonic; /* ascending */
	uint32_t count, stride;
	float *value;  /* [half theta_h][half theta_d][stride] */
	float *matrix; /* [count][columns]: their cosines at the cells that are wanted */
};

/* SPECTRUM_BLOCK harmonics from the n-th in use on: plane[theta_h][theta_d][harmonic], its even rows and columns to n->value. */
static void harmonics_invert(const struct spectrum_inverse *inverse, const struct spectral_terms *terms, const uint32_t *start,
                             struct narrow *n, uint32_t first, float *plane)
{
	const struct lattice_dims d = inverse->dims;
	const uint32_t count = n->count - first < SPECTRUM_BLOCK ? n->count - first : SPECTRUM_BLOCK;

	memset(plane, 0, (size_t)d.theta_h * d.theta_d * SPECTRUM_BLOCK * sizeof *plane);
	for (uint32_t q = 0; q < count; q++) {
		const uint32_t m = n->harmonic[first + q];
		for (uint32_t i = start[m]; i < start[m + 1]; i++)
			plane[(size_t)terms->term[i].place * SPECTRUM_BLOCK + q] = terms->term[i].value;
	}
	spectral_kernels_get()->cdf97_plane(plane, d.theta_h, d.theta_d, inverse->levels, 1);
	for (uint32_t i = 0; i < d.theta_h / 2; i++)
		for (uint32_t j = 0; j < d.theta_d / 2; j++)
			memcpy(n->value + ((size_t)i * (d.theta_d / 2) + j) * n->stride + first,
			       plane + (2 * (size_t)i * d.theta_d + 2 * (size_t)j) * SPECTRUM_BLOCK, SPECTRUM_BLOCK * sizeof *plane);
}

static bp_status narrow_make(const struct spectrum_inverse *inverse, const struct spectral_terms *terms, const uint32_t *start,
                             size_t columns, float *plane, struct narrow *out, bp_error *error)
{
	const struct lattice_dims d = inverse->dims;

	out->harmonic = malloc(d.phi_d * sizeof *out->harmonic);
	if (!out->harmonic)
		return error_memory(error, d.phi_d * sizeof *out->harmonic);
	for (uint32_t m = 0; m < d.phi_d; m++)
		if (start[m + 1] > start[m])
			out->harmonic[out->count++] = m;
	out->stride = (out->count + SPECTRUM_BLOCK - 1) / SPECTRUM_BLOCK * SPECTRUM_BLOCK;
	const size_t bytes = out->stride * ((size_t)d.theta_h / 2 * (d.theta_d / 2) + columns) * sizeof(float);
	out->value = malloc(bytes ? bytes : 1);
	if (!out->value)
		return error_memory(error, bytes);
	out->matrix = out->value + (size_t)d.theta_h / 2 * (d.theta_d / 2) * out->stride;
	for (uint32_t n = 0; n < out->count; n++)
		spectrum_inverse_cosines(inverse, out->harmonic[n], 0, 2, (uint32_t)columns, out->matrix + n * columns);
	for (uint32_t first = 0; first < out->count; first += SPECTRUM_BLOCK)
		harmonics_invert(inverse, terms, start, out, first, plane);
	return BP_OK;
}

bp_status spectral_expand_half_blocks(const struct spectral_model *model, uint32_t layers, spectral_block_fn *take, void *user,
                                      bp_error *error)
{
	const struct lattice_dims d = model->dims, h = {d.theta_h / 2, d.theta_d / 2, d.phi_d / 2};
	const size_t columns = (h.phi_d + COLUMNS_STEP - 1) / COLUMNS_STEP * COLUMNS_STEP, piece = ROWS_STEP * columns;
	const size_t plane_bytes = (size_t)d.theta_h * d.theta_d * SPECTRUM_BLOCK * sizeof(float);
	struct narrow narrow[3] = {{0}};
	struct spectrum_inverse *inverse = NULL;
	struct spectral_terms terms = {0};
	float *plane = memory_alloc(plane_bytes), *fields = malloc(3 * piece * sizeof(float));
	bp_status status = plane && fields ? spectrum_inverse_create(d, &inverse, error) : error_memory(error, plane_bytes);

	if (!status)
		status = spectral_weights_apply(&model->weights, inverse, error);
	if (!status)
		status = spectral_terms_make(model, inverse, layers, &terms, error);
	for (size_t f = 0; !status && f < 3; f++)
		status = narrow_make(inverse, &terms, terms.start + f * d.phi_d, columns, plane, &narrow[f], error);
	const size_t rows = (size_t)h.theta_h * h.theta_d;
	for (size_t r = 0; !status && r < rows; r += ROWS_STEP) {
		const struct spectral_block block = {
			.field = {fields, fields + piece, fields + 2 * piece},
			.row = r,
			.rows = rows - r < ROWS_STEP ? rows - r : ROWS_STEP,
			.width = h.phi_d,
			.stride = columns,
		};
		for (size_t f = 0; f < 3; f++)
			spectral_kernels_get()->cosine_product(narrow[f].value + r * narrow[f].stride, narrow[f].stride, block.rows,
			                                       narrow[f].count, narrow[f].matrix, columns, fields + f * piece, columns);
		take(user, &block);
	}
	for (int f = 0; f < 3; f++) {
		free(narrow[f].harmonic);
		free(narrow[f].value);
	}
	spectral_terms_free(&terms);
	spectrum_inverse_free(inverse);
	free(plane);
	free(fields);
	return status;
}
