/*
 * range_coder.h: an adaptive binary range coder (Martin 1979; carries as in the LZMA coder), written
 * out in FORMAT.md, "Range coder". Deterministic everywhere: integers only.
 *
 * A decoder reads exactly the bytes that the encoder wrote; where a damaged stream asks for more it gets
 * zeros, and range_decoder_ended tells.
 */
#ifndef CODEC_RANGE_CODER_H
#define CODEC_RANGE_CODER_H

#include "bytes.h"

/* An adaptive probability of 0: probability / 65536, 1..65535; `seen` makes the first steps long. */
struct bit_model {
	uint16_t probability, seen;
};

enum { BIT_MODEL_EVEN = 1 << 15, BIT_MODEL_SHIFT_MAX = 7 };

void bit_models_reset(struct bit_model *models, size_t count);

struct range_encoder {
	struct byte_buffer *out;
	uint64_t low;
	uint32_t range, cache;
	uint64_t pending; /* bytes held back until their carry is known, the cache included */
	uint32_t started; /* the first byte is always 0 and is not written */
};

void range_encoder_start(struct range_encoder *encoder, struct byte_buffer *out);
void range_encode(struct range_encoder *encoder, struct bit_model *model, uint32_t bit);
/* The lowest `count` bits of value (0..24), the highest first, each with probability 1/2. */
void range_encode_even(struct range_encoder *encoder, uint32_t value, uint32_t count);
/* Writes the bytes that were held back, now that their carry is known; `first`: their first one is not written. */
void range_bytes_write(struct byte_buffer *out, uint32_t cache, uint64_t pending, uint32_t carry, int first);
/* Moves the top byte of low out, once no later carry can change it. Members are passed on, so that they can be in registers. */
static inline void range_encoder_shift(struct range_encoder *encoder)
{
	if (encoder->low < UINT32_C(0xFF000000) || encoder->low > UINT32_MAX) {
		range_bytes_write(encoder->out, encoder->cache, encoder->pending, (uint32_t)(encoder->low >> 32), !encoder->started);
		encoder->started = 1;
		encoder->pending = 0;
		encoder->cache = (uint32_t)(encoder->low >> 24) & 0xFF;
	}
	encoder->pending++;
	encoder->low = (encoder->low & 0x00FFFFFF) << 8;
}
static inline void range_encoder_refill(struct range_encoder *encoder)
{
	while (encoder->range < 1u << 24) { /* range is kept at or above this */
		encoder->range <<= 8;
		range_encoder_shift(encoder);
	}
}
/* A bit that is 0 with the probability p / 65536, p = 1..65535, from the caller. No branch on the bit: half of them surprise. */
static inline void range_encode_with(struct range_encoder *encoder, uint32_t p, uint32_t bit)
{
	const uint32_t bound = (encoder->range >> 16) * p;
	encoder->low += bound & -bit;
	encoder->range = bit ? encoder->range - bound : bound;
	range_encoder_refill(encoder);
}
/* Bytes that the stream would take if it were ended now. */
static inline size_t range_encoder_bytes(const struct range_encoder *encoder)
{
	return encoder->out->count + (size_t)encoder->pending + 4;
}
void range_encoder_end(struct range_encoder *encoder);

struct range_decoder {
	const uint8_t *bytes;
	size_t count, at; /* at may pass count: zeros follow */
	uint32_t range, code;
};

void range_decoder_start(struct range_decoder *decoder, const uint8_t *bytes, size_t count);
uint32_t range_decode(struct range_decoder *decoder, struct bit_model *model);
uint32_t range_decode_even(struct range_decoder *decoder, uint32_t count);
static inline void range_decoder_shift(struct range_decoder *decoder)
{
	decoder->code = decoder->code << 8 | (decoder->at < decoder->count ? decoder->bytes[decoder->at] : 0);
	decoder->at++;
}
static inline void range_decoder_refill(struct range_decoder *decoder)
{
	while (__builtin_expect(decoder->range < 1u << 24, 0)) { /* about one bit in twenty */
		decoder->range <<= 8;
		range_decoder_shift(decoder);
	}
}
/* Two ways that do not meet: whatever follows from the bit follows without asking for it again. */
static inline uint32_t range_decode_with(struct range_decoder *decoder, uint32_t p)
{
	const uint32_t bound = (decoder->range >> 16) * p;
	if (decoder->code >= bound) {
		decoder->code -= bound;
		decoder->range -= bound;
		range_decoder_refill(decoder);
		return 1;
	}
	decoder->range = bound;
	range_decoder_refill(decoder);
	return 0;
}
/* True when exactly the bytes given were used: what an intact stream shows behind its last bit. */
static inline int range_decoder_ended(const struct range_decoder *decoder) { return decoder->at == decoder->count; }

/*
 * Numbers 0..2^24-2 in Elias's gamma manner: the length of value + 1 in unary with a model per place, then
 * the bits below its highest one, the first two of them modelled.
 */
enum { GAMMA_LENGTH_MAX = 24 };
struct gamma_model {
	struct bit_model length[GAMMA_LENGTH_MAX], first[GAMMA_LENGTH_MAX], second[GAMMA_LENGTH_MAX][2];
};

void gamma_encode(struct range_encoder *encoder, struct gamma_model *model, uint32_t value);
uint32_t gamma_decode(struct range_decoder *decoder, struct gamma_model *model);
/* Bits below the highest one of value + 1: 0 for 0, 1 for 1..2, 2 for 3..6, ... */
uint32_t gamma_length(uint32_t value);

#endif
