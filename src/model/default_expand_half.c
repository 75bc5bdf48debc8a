/*
 * default_expand_half.c: every second corner of the table, without computing the others: what a preview needs.
 *
 * A preview's layers use few harmonics, so the spectra are kept with their lanes close together; the wavelets run on
 * all rows (the last step along theta_d on every second), the cosines and exponentials on a quarter and an eighth.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "default_model.h"
#include "kernels.h"
#include "spectrum.h"

enum { COLUMNS_STEP = 16 }; /* cosine_product works on so many columns at once */

/* Spectra of the three fields with `lanes` values per row: first the even harmonics in use, then the odd ones. */
struct narrow {
	uint32_t used[2], lanes;
	float *field[3];
	float *scratch;
};

static bp_status narrow_make(const struct default_model *m, struct lattice_dims d, uint32_t layers, struct narrow *out, bp_error *error)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d, longest = d.theta_h > d.theta_d ? d.theta_h : d.theta_d;
	struct default_place place;

	*out = (struct narrow){0};
	for (uint32_t i = 0; i < m->level_count; i++)
		if (default_level_value(m, d, layers, &m->levels[i], &place) != 0 && place.order + 1 > out->used[place.kind])
			out->used[place.kind] = place.order + 1;
	out->lanes = out->used[0] + out->used[1];
	if (out->lanes == 0)
		out->lanes = out->used[0] = 1;
	out->field[0] = calloc(3 * rows * out->lanes, sizeof(float));
	out->scratch = malloc(longest * out->lanes * sizeof(float));
	if (!out->field[0] || !out->scratch)
		return error_memory(error, 3 * rows * out->lanes * sizeof(float));
	out->field[1] = out->field[0] + rows * out->lanes;
	out->field[2] = out->field[1] + rows * out->lanes;
	for (uint32_t i = 0; i < m->level_count; i++) {
		const float value = default_level_value(m, d, layers, &m->levels[i], &place);
		if (value != 0)
			out->field[place.field][(size_t)place.row * out->lanes + place.order + (place.kind ? out->used[0] : 0)] = value;
	}
	return BP_OK;
}

static void narrow_wavelets(const struct narrow *n, struct lattice_dims d, float *table)
{
	const struct kernels *kernels = kernels_get();
	const size_t slice = (size_t)d.theta_d * n->lanes;

	for (uint32_t l = spectrum_levels(d.theta_h, d.theta_d); l-- > 0;) {
		const size_t rows = (d.theta_h + ((size_t)1 << l) - 1) >> l, columns = (d.theta_d + ((size_t)1 << l) - 1) >> l;
		for (size_t j = 0; j < columns; j++)
			kernels->cdf97_inverse(table + j * n->lanes, rows, slice, n->lanes, n->scratch);
		for (size_t i = 0; i < rows; i += l ? 1 : 2)
			kernels->cdf97_inverse(table + i * slice, columns, n->lanes, n->lanes, n->scratch);
	}
}

/* matrix[lane][cell / 2], for the cosines of spectrum.h */
static void cosines_fill(const struct narrow *n, uint32_t p, size_t columns, float *matrix)
{
	for (uint32_t lane = 0; lane < n->lanes; lane++) {
		const uint32_t m = lane < n->used[0] ? 2 * lane : 2 * (lane - n->used[0]) + 1;
		const double scale = sqrt((m ? 2.0 : 1.0) / p);
		for (uint32_t k = 0; k < p / 2; k++)
			matrix[lane * columns + k] = (float)(scale * spectrum_cosine((uint64_t)m * (4 * k + 1), p));
	}
}

bp_status default_expand_half(const struct model *model, uint32_t layers, struct expansion *out, bp_error *error)
{
	const struct kernels *kernels = kernels_get();
	const struct default_model *m = model->log_density;
	const struct lattice_dims d = model->dims, h = out->dims;
	const size_t columns = (h.phi_d + COLUMNS_STEP - 1) / COLUMNS_STEP * COLUMNS_STEP, slice = (size_t)h.theta_d * h.phi_d;
	struct narrow narrow = {0};
	float *matrix = NULL, *product = malloc(h.theta_d * columns * sizeof(float)), *fields = malloc(3 * slice * sizeof(float));
	bp_status status = product && fields ? narrow_make(m, d, layers, &narrow, error) : error_memory(error, 3 * slice * sizeof(float));

	if (status)
		goto out;
	matrix = calloc(narrow.lanes * columns, sizeof(float));
	if (!matrix) {
		status = error_memory(error, narrow.lanes * columns * sizeof(float));
		goto out;
	}
	cosines_fill(&narrow, d.phi_d, columns, matrix);
	for (int f = 0; f < 3; f++)
		narrow_wavelets(&narrow, d, narrow.field[f]);
	for (size_t i = 0; i < h.theta_h; i++) {
		const float *const field[3] = {fields, fields + slice, fields + 2 * slice};
		float *const rgb[3] = {out->rgb[0] + i * slice, out->rgb[1] + i * slice, out->rgb[2] + i * slice};
		for (int f = 0; f < 3; f++) {
			const float *row = narrow.field[f] + 2 * i * d.theta_d * narrow.lanes;
			kernels->cosine_product(row, 2 * (size_t)narrow.lanes, h.theta_d, narrow.lanes, matrix, columns, product, columns);
			for (size_t j = 0; j < h.theta_d; j++)
				memcpy(fields + (size_t)f * slice + j * h.phi_d, product + j * columns, h.phi_d * sizeof(float));
		}
		kernels->default_values(field, slice, m->base, (const float(*)[3])m->rotation, DEFAULT_OFFSET, rgb);
	}
	out->unit = m->unit;
out:
	free(narrow.field[0]);
	free(narrow.scratch);
	free(matrix);
	free(product);
	free(fields);
	return status;
}
