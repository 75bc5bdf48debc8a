#include "sparse_code.h"

#include <stdlib.h>

#include "error.h"

bp_status sparse_coder_create(struct lattice_dims dims, enum paper_field kind, struct sparse_coder **out, bp_error *error)
{
	const uint32_t cells = paper_plane_cells(dims, kind);
	const size_t bytes = sizeof(struct sparse_coder) + cells * (sizeof(uint32_t) + 2);
	struct sparse_coder *coder = calloc(bytes, 1);

	if (!coder)
		return error_memory(error, bytes);
	coder->cells = cells;
	coder->band = (uint8_t *)(coder->marks + cells);
	coder->before = coder->band + cells;
	paper_plane_bands(dims, kind, coder->band);
	for (uint32_t i = 0; i < cells; i++)
		coder->band[i] = coder->band[i] < SPARSE_BANDS ? coder->band[i] : SPARSE_BANDS - 1;
	bit_models_reset((struct bit_model *)&coder->models, sizeof coder->models / sizeof(struct bit_model));
	*out = coder;
	return BP_OK;
}

/* Large follows large: the context is the size class of the number before. */
static uint32_t context_of(uint32_t before)
{
	uint32_t length = gamma_length(before);
	return length < SPARSE_GAPS ? length : SPARSE_GAPS - 1;
}

/* The field just coded becomes what the next one is expected to resemble. */
static void field_remember(struct sparse_coder *coder, const struct sparse_field *field)
{
	for (uint32_t i = 0; i < coder->mark_count; i++)
		coder->before[coder->marks[i]] = 0;
	for (uint32_t i = 0; i < field->count; i++) {
		const int32_t magnitude = field->level[i] < 0 ? -field->level[i] : field->level[i];
		coder->before[field->index[i]] = (uint8_t)(magnitude < SPARSE_BEFORE ? magnitude : SPARSE_BEFORE - 1);
		coder->marks[i] = field->index[i];
	}
	coder->mark_count = field->count;
}

void sparse_encode(struct range_encoder *encoder, struct sparse_coder *coder, const struct sparse_field *field)
{
	struct sparse_models *models = &coder->models;
	uint32_t next = 0, gap_before = 0;

	gamma_encode(encoder, &models->count, field->count - 1);
	for (uint32_t i = 0; i < field->count; i++) {
		const uint32_t at = field->index[i], gap = at - next;
		const int32_t level = field->level[i];

		gamma_encode(encoder, &models->gap[context_of(gap_before)], gap);
		gamma_encode(encoder, &models->magnitude[coder->band[at]][coder->before[at]], (uint32_t)(level < 0 ? -level : level) - 1);
		range_encode_even(encoder, level < 0, 1);
		next = at + 1;
		gap_before = gap;
	}
	field_remember(coder, field);
}

bp_status sparse_decode(struct range_decoder *decoder, struct sparse_coder *coder, size_t most, struct sparse_field *field,
                        bp_error *error)
{
	struct sparse_models *models = &coder->models;
	const uint32_t count = gamma_decode(decoder, &models->count) + 1;
	uint32_t next = 0, gap = 0;

	if (count > coder->cells || count > most)
		return error_set(error, BP_ERROR_CORRUPT, decoder->at,
		                 "a field of %u coefficients: its plane has %u, and %zu can be in these bytes", count, coder->cells,
		                 most);
	const bp_status status = sparse_field_alloc(count, field, error);
	if (status)
		return status;
	for (uint32_t i = 0; i < count; i++) {
		gap = gamma_decode(decoder, &models->gap[context_of(gap)]);
		if (gap >= coder->cells - next)
			return error_set(error, BP_ERROR_CORRUPT, decoder->at, "coefficient %u lies outside its plane of %u", i,
			                 coder->cells);
		const uint32_t at = next + gap, magnitude = gamma_decode(decoder, &models->magnitude[coder->band[at]][coder->before[at]]);
		const uint32_t negative = range_decode_even(decoder, 1);
		if (magnitude >= PAPER_LEVEL_MAX)
			return error_set(error, BP_ERROR_CORRUPT, decoder->at, "coefficient %u has a level of %u, at most %d are possible", i,
			                 magnitude + 1, PAPER_LEVEL_MAX);
		field->index[i] = at;
		field->level[i] = negative ? -(int32_t)magnitude - 1 : (int32_t)magnitude + 1;
		next = at + 1;
	}
	field->count = count;
	field_remember(coder, field);
	return BP_OK;
}
