#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "paper_fields.h"

/* ---- marginals ---- */

void marginals_write(struct lattice_dims dims, const struct paper_channel *channel, struct byte_buffer *out)
{
	write_f64(out, channel->scale);
	for (size_t i = 0; i < paper_marginal_values(dims); i++)
		write_u16(out, paper_code(channel->marginal[0][i]));
}

bp_status marginals_read(struct byte_reader *in, struct lattice_dims dims, double specular, struct paper_channel *channel,
                         bp_error *error)
{
	channel->scale = read_f64(in);
	if (!(channel->scale >= 0) || !isfinite(channel->scale))
		return error_set(error, BP_ERROR_CORRUPT, 0, "the scale is %g", channel->scale);
	if (!isfinite(specular * channel->scale))
		return error_set(error, BP_ERROR_CORRUPT, 0, "the scale %g and the specular parameter %g overflow", channel->scale,
		                 specular);
	const bp_status status = paper_marginals_alloc(dims, channel, error);
	if (status)
		return status;
	for (size_t i = 0; i < paper_marginal_values(dims); i++)
		channel->marginal[0][i] = paper_coded(read_u16(in));
	if (in->failed || byte_reader_left(in))
		return error_set(error, BP_ERROR_CORRUPT, 0, "marginals of %ux%ux%u cells take other than these bytes", dims.theta_h,
		                 dims.theta_d, dims.phi_d);
	return BP_OK;
}

/* ---- sparse fields ---- */

enum { SPARSE_GAPS = 8, SPARSE_BANDS = 12, SPARSE_BEFORE = 4 };

/* Statistics that the fields of one section share. */
struct sparse_models {
	struct gamma_model count, gap[SPARSE_GAPS], magnitude[SPARSE_BANDS][SPARSE_BEFORE];
};

struct sparse_coder {
	struct sparse_models models;
	uint32_t cells;  /* of the plane */
	uint8_t *band;   /* [cells]: how fine the coefficients are, 0 coarse */
	uint8_t *before; /* [cells]: min(|level|, 3) of the field before; 0 at first */
	uint32_t mark_count;
	uint32_t marks[]; /* where it is not 0; behind them the arrays above */
};

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

bp_status fields_write(struct lattice_dims dims, enum paper_field kind, const struct sparse_field *fields, uint32_t count,
                       struct byte_buffer *out, bp_error *error)
{
	struct sparse_coder *coder = NULL;
	struct range_encoder encoder;
	bp_status status = sparse_coder_create(dims, kind, &coder, error);

	if (status)
		return status;
	for (uint32_t i = 0; i < count; i++)
		write_u16(out, fields[i].count ? fields[i].step : 0);
	range_encoder_start(&encoder, out);
	for (uint32_t i = 0; i < count; i++)
		if (fields[i].count)
			sparse_encode(&encoder, coder, &fields[i]);
	range_encoder_end(&encoder);
	free(coder);
	return out->failed ? error_memory(error, out->count) : BP_OK;
}

/* Every coefficient takes at least the bit of its sign, so the bytes that are there bound what is allocated. */
bp_status fields_read(struct byte_reader *in, struct lattice_dims dims, enum paper_field kind, struct sparse_field *fields,
                      uint32_t count, bp_error *error)
{
	struct sparse_coder *coder = NULL;
	struct range_decoder decoder;
	bool there = false;

	for (uint32_t i = 0; i < count; i++) {
		fields[i].step = read_u16(in);
		there |= fields[i].step != 0;
		if (in->failed || (fields[i].step && (fields[i].step < PAPER_STEP_LEAST || fields[i].step > PAPER_STEP_MOST)))
			return error_set(error, BP_ERROR_CORRUPT, in->at, "field %u has the step %u; 0 or %d to %d are possible", i,
			                 fields[i].step, PAPER_STEP_LEAST, PAPER_STEP_MOST);
	}
	if (!there)
		return error_set(error, BP_ERROR_CORRUPT, in->at, "a section of fields without any");
	bp_status status = sparse_coder_create(dims, kind, &coder, error);
	size_t most = 8 * byte_reader_left(in);
	range_decoder_start(&decoder, in->bytes + in->at, byte_reader_left(in));
	for (uint32_t i = 0; !status && i < count; i++)
		if (fields[i].step) {
			status = sparse_decode(&decoder, coder, most, &fields[i], error);
			most -= fields[i].count < most ? fields[i].count : most;
		}
	if (!status && !range_decoder_ended(&decoder))
		status = error_set(error, BP_ERROR_CORRUPT, in->at, "the coefficients take %zu bytes, %zu are there", decoder.at,
		                   decoder.count);
	free(coder);
	return status;
}

/* Octaves that slices lose before the pairs begin to. */
enum { PAIRS_LATER = 2 * 256 };

static bp_status field_coarsen(const struct sparse_field *from, double factor, uint32_t shift, struct sparse_field *to,
                               bp_error *error)
{
	const uint32_t step = from->step + shift;

	if (!from->count || step > PAPER_STEP_MOST)
		return BP_OK;
	to->step = (uint16_t)step;
	const bp_status status = sparse_field_alloc(from->count, to, error);
	if (status)
		return status;
	for (uint32_t i = 0; i < from->count; i++) {
		const int32_t level = (int32_t)lrint(from->level[i] * factor);
		if (!level)
			continue;
		to->index[to->count] = from->index[i];
		to->level[to->count++] = level;
	}
	return BP_OK;
}

bp_status fields_coarsen(enum paper_field kind, const struct sparse_field *fields, uint32_t count, uint32_t shift,
                         struct sparse_field **out, bp_error *error)
{
	struct sparse_field *coarse = calloc(count ? count : 1, sizeof *coarse);
	bp_status status = coarse ? BP_OK : error_memory(error, count * sizeof *coarse);

	*out = coarse;
	if (status || shift >= SPARSE_SHIFT_MAX)
		return status;
	if (kind != PAPER_SLICE)
		shift = shift > PAIRS_LATER ? shift - PAIRS_LATER : 0;
	const double factor = 1 / (double)paper_step((uint16_t)(PAPER_STEP_ONE + shift));
	for (uint32_t i = 0; !status && i < count; i++)
		status = field_coarsen(&fields[i], factor, shift, &coarse[i], error);
	return status;
}
