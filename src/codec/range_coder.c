#include "range_coder.h"

void bit_models_reset(struct bit_model *models, size_t count)
{
	for (size_t i = 0; i < count; i++)
		models[i] = (struct bit_model){.probability = BIT_MODEL_EVEN};
}

/*
 * The n-th bit a model sees moves it by 1/2^shift with shift = min(2 + n/4, 7): quick at first, then the
 * average of about 128 bits. A probability below 2^shift does not shrink further, so it never reaches 0,
 * nor, likewise, 65536.
 */
static void model_update(struct bit_model *model, uint32_t bit)
{
	uint32_t shift = 2 + model->seen / 4u;
	if (shift >= BIT_MODEL_SHIFT_MAX)
		shift = BIT_MODEL_SHIFT_MAX;
	else
		model->seen++;
	if (bit)
		model->probability = (uint16_t)(model->probability - (model->probability >> shift));
	else
		model->probability = (uint16_t)(model->probability + ((65536u - model->probability) >> shift));
}

void range_encoder_start(struct range_encoder *encoder, struct byte_buffer *out)
{
	*encoder = (struct range_encoder){.out = out, .range = UINT32_MAX, .pending = 1};
}

void range_bytes_write(struct byte_buffer *out, uint32_t cache, uint64_t pending, uint32_t carry, int first)
{
	for (uint64_t i = first ? 1 : 0; i < pending; i++)
		write_u8(out, (uint8_t)((i ? 0xFF : cache) + carry));
}

void range_encode(struct range_encoder *encoder, struct bit_model *model, uint32_t bit)
{
	range_encode_with(encoder, model->probability, bit);
	model_update(model, bit);
}

void range_encode_even(struct range_encoder *encoder, uint32_t value, uint32_t count)
{
	while (count-- > 0) {
		encoder->range >>= 1;
		if (value >> count & 1)
			encoder->low += encoder->range;
		range_encoder_refill(encoder);
	}
}

void range_encoder_end(struct range_encoder *encoder)
{
	for (int i = 0; i < 5; i++)
		range_encoder_shift(encoder);
}

void range_decoder_start(struct range_decoder *decoder, const uint8_t *bytes, size_t count)
{
	*decoder = (struct range_decoder){.bytes = bytes, .count = count, .range = UINT32_MAX};
	for (int i = 0; i < 4; i++)
		range_decoder_shift(decoder);
}

uint32_t range_decode(struct range_decoder *decoder, struct bit_model *model)
{
	const uint32_t bit = range_decode_with(decoder, model->probability);
	model_update(model, bit);
	return bit;
}

uint32_t range_decode_even(struct range_decoder *decoder, uint32_t count)
{
	uint32_t value = 0;
	while (count-- > 0) {
		decoder->range >>= 1;
		uint32_t bit = decoder->code >= decoder->range;
		if (bit)
			decoder->code -= decoder->range;
		value = value << 1 | bit;
		range_decoder_refill(decoder);
	}
	return value;
}

uint32_t gamma_length(uint32_t value)
{
	uint32_t length = 0;
	while ((value + 1) >> (length + 1))
		length++;
	return length;
}

void gamma_encode(struct range_encoder *encoder, struct gamma_model *model, uint32_t value)
{
	uint32_t length = gamma_length(value), rest = value + 1, place = length;
	for (uint32_t i = 0; i < length; i++)
		range_encode(encoder, &model->length[i], 1);
	if (length < GAMMA_LENGTH_MAX - 1)
		range_encode(encoder, &model->length[length], 0);
	if (place > 0) {
		uint32_t first = rest >> --place & 1;
		range_encode(encoder, &model->first[length], first);
		if (place > 0) {
			place--;
			range_encode(encoder, &model->second[length][first], rest >> place & 1);
			range_encode_even(encoder, rest & ((1u << place) - 1), place);
		}
	}
}

uint32_t gamma_decode(struct range_decoder *decoder, struct gamma_model *model)
{
	uint32_t length = 0, rest = 1, place;
	while (length < GAMMA_LENGTH_MAX - 1 && range_decode(decoder, &model->length[length]))
		length++;
	place = length;
	if (place > 0) {
		uint32_t first = range_decode(decoder, &model->first[length]);
		rest = rest << 1 | first;
		place--;
		if (place > 0) {
			rest = rest << 1 | range_decode(decoder, &model->second[length][first]);
			place--;
			rest = rest << place | range_decode_even(decoder, place);
		}
	}
	return rest - 1;
}
