/* paper.c: what fitting and expanding the paper's model share. */
#include "paper.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "model/math/fast_math.h"

/* ---- extents and planes ---- */

uint32_t paper_shared_from(uint32_t theta_h)
{
	uint32_t i = 0;

	while ((uint64_t)9 * i * i < (uint64_t)4 * theta_h * theta_h)
		i++;
	return i;
}

void paper_field_extents(struct lattice_dims dims, enum paper_field field, uint32_t *rows, uint32_t *columns)
{
	*rows = field == PAPER_SLICE ? dims.theta_d : dims.theta_h;
	*columns = field == PAPER_HD ? dims.theta_d : dims.phi_d;
}

struct wavelet_plane paper_plane(struct lattice_dims dims, enum paper_field field)
{
	uint32_t rows, columns;

	paper_field_extents(dims, field, &rows, &columns);
	return wavelet_plane_for(field == PAPER_SLICE ? WAVELET_DAUBECHIES : WAVELET_HAAR, rows, columns, field != PAPER_HD);
}

uint32_t paper_plane_cells(struct lattice_dims dims, enum paper_field field)
{
	const struct wavelet_plane plane = paper_plane(dims, field);
	return (uint32_t)wavelet_cells(&plane);
}

/* 0 for the coarse coefficients of an axis, then 1 for the coarsest details. */
static uint32_t level_of(struct wavelet_axis axis, uint32_t at)
{
	uint32_t level = 0;

	while (level < axis.levels && at >= axis.plane >> (axis.levels - level))
		level++;
	return level;
}

void paper_plane_bands(struct lattice_dims dims, enum paper_field field, uint8_t *band)
{
	const struct wavelet_plane p = paper_plane(dims, field);

	for (uint32_t column = 0; column < p.columns.plane * p.parts; column++)
		for (uint32_t row = 0; row < p.rows.plane; row++)
			band[(size_t)column * p.rows.plane + row] =
				(uint8_t)(level_of(p.columns, column % p.columns.plane) + level_of(p.rows, row));
}

uint32_t paper_keep(struct lattice_dims dims, enum paper_field field)
{
	uint32_t rows, columns;

	paper_field_extents(dims, field, &rows, &columns);
	const uint32_t one = rows * columns / (field == PAPER_SLICE ? PAPER_KEEP_SLICE : PAPER_KEEP_PAIR);
	return (one ? one : 1) * (field == PAPER_SLICE ? paper_shared_from(dims.theta_h) + 1 : 1);
}

/* ---- numbers ---- */

float paper_step(uint16_t code) { return (float)fast_exp2(((int)code - PAPER_STEP_ONE) / 256.0); }

float paper_coded(uint16_t code) { return code ? (float)fast_exp2(((int)code - (1 << 15)) / 1024.0) : 0; }

uint16_t paper_code(float marginal)
{
	if (!(marginal > 0))
		return 0;
	const long code = lrint(1024 * fast_log2((double)marginal)) + (1 << 15);
	return (uint16_t)(code < 1 ? 1 : code > UINT16_MAX ? UINT16_MAX : code);
}

/* ---- memory ---- */

bp_status sparse_field_alloc(uint32_t count, struct sparse_field *field, bp_error *error)
{
	field->index = malloc(count * sizeof *field->index);
	field->level = malloc(count * sizeof *field->level);
	return field->index && field->level ? BP_OK : error_memory(error, count * (sizeof *field->index + sizeof *field->level));
}

void sparse_field_free(struct sparse_field *field)
{
	free(field->index);
	free(field->level);
	field->index = NULL;
	field->level = NULL;
	field->count = 0;
}

void sparse_fields_free(struct sparse_field *fields, uint32_t count)
{
	for (uint32_t i = 0; fields && i < count; i++)
		sparse_field_free(&fields[i]);
	free(fields);
}

bp_status paper_marginals_alloc(struct lattice_dims dims, struct paper_channel *channel, bp_error *error)
{
	const size_t bytes = paper_marginal_values(dims) * sizeof(float);

	channel->marginal[0] = malloc(bytes);
	if (!channel->marginal[0])
		return error_memory(error, bytes);
	channel->marginal[1] = channel->marginal[0] + dims.theta_h;
	channel->marginal[2] = channel->marginal[1] + dims.theta_d;
	return BP_OK;
}

void paper_free(struct paper_model *paper)
{
	if (!paper)
		return;
	for (int c = 0; c < 3; c++) {
		struct paper_channel *channel = &paper->channel[c];
		free(channel->marginal[0]);
		sparse_field_free(&channel->hd);
		sparse_field_free(&channel->hphi);
		sparse_fields_free(channel->slice, channel->slice_count);
	}
	free(paper);
}
