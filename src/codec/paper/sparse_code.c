#include "sparse_code.h"

#include "error.h"

void sparse_models_reset(struct sparse_models *models)
{
	bit_models_reset((struct bit_model *)models, sizeof *models / sizeof(struct bit_model));
}

/* Large follows large: the context is the size class of the number before. */
static uint32_t context_of(uint32_t before)
{
	uint32_t length = gamma_length(before);
	return length < SPARSE_CONTEXTS ? length : SPARSE_CONTEXTS - 1;
}

void sparse_encode(struct range_encoder *encoder, struct sparse_models *models, const struct sparse_field *field)
{
	uint32_t next = 0, gap_before = 0, magnitude_before = 0;
	for (uint32_t i = 0; i < field->count; i++) {
		int level = field->level[i];
		uint32_t gap = field->index[i] - next, magnitude = (uint32_t)(level < 0 ? -level : level) - 1;
		gamma_encode(encoder, &models->gap[context_of(gap_before)], gap);
		gamma_encode(encoder, &models->magnitude[context_of(magnitude_before)], magnitude);
		range_encode_even(encoder, level < 0, 1);
		next = field->index[i] + 1;
		gap_before = gap;
		magnitude_before = magnitude;
	}
}

bp_status sparse_decode(struct range_decoder *decoder, struct sparse_models *models, uint32_t plane_cells,
                        struct sparse_field *field, bp_error *error)
{
	uint32_t next = 0, gap_before = 0, magnitude_before = 0;
	for (uint32_t i = 0; i < field->count; i++) {
		uint32_t gap = gamma_decode(decoder, &models->gap[context_of(gap_before)]);
		uint32_t magnitude = gamma_decode(decoder, &models->magnitude[context_of(magnitude_before)]);
		uint32_t negative = range_decode_even(decoder, 1);
		if (gap >= plane_cells - next)
			return error_set(error, BP_ERROR_CORRUPT, decoder->at, "coefficient %u lies outside its plane of %u", i, plane_cells);
		if (magnitude > INT16_MAX - 1)
			return error_set(error, BP_ERROR_CORRUPT, decoder->at, "coefficient %u has a level of %u, at most %d are possible", i,
			                 magnitude + 1, INT16_MAX);
		field->index[i] = next + gap;
		field->level[i] = (int16_t)(negative ? -(int)magnitude - 1 : (int)magnitude + 1);
		next = field->index[i] + 1;
		gap_before = gap;
		magnitude_before = magnitude;
	}
	return BP_OK;
}
