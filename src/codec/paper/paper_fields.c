#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "paper_fields.h"
#include "sparse_code.h"

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
