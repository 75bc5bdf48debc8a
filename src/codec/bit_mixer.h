/*
 * bit_mixer.h: predicts a bit from several contexts at once: every context has an adaptive probability, and a
 * small online regression in the logistic domain (Mattern 2012; the PAQ coders of Mahoney) weighs them. Integers only; FORMAT.md, "Mixed bits".
 */
#ifndef CODEC_BIT_MIXER_H
#define CODEC_BIT_MIXER_H

#include <stdint.h>

#include "range_coder.h"

enum { MIXER_INPUTS = 4, MIXER_PROBABILITY_BITS = 22 };

/* A probability of 1 in the upper 22 bits, and how many bits it has seen (up to a limit) in the lower 10. */
typedef uint32_t mixer_context;
#define MIXER_CONTEXT_EVEN (UINT32_C(1) << 31)

/* Weights in units of 1/65536. */
struct mixer_weights {
	int32_t w[MIXER_INPUTS];
};
enum { MIXER_WEIGHT_START = 19661, MIXER_WEIGHT_MAX = 1 << 24, MIXER_SEEN_MAX = 60, MIXER_SEEN_MAX_ALONE = 250 };

/* Tables, the same for all: stretch[i] = ln(p/(1-p)) of p = (i + 1/2)/4096, and its inverse, both with 8 bits behind the point. */
struct mixer_tables {
	int16_t stretch[4096];
	uint16_t squash[4096];
	uint32_t rate[256]; /* how far a context that has seen n bits moves: 65536/(n + 1.6) */
};
const struct mixer_tables *mixer_tables_get(void); /* thread-safe */

/* Encoder or decoder, whichever is set. */
struct mixed_coder {
	struct range_encoder *encoder;
	struct range_decoder decoder;
	const struct mixer_tables *tables;
};

static inline void mixer_context_learn(const struct mixer_tables *tables, mixer_context *context, uint32_t bit, uint32_t limit)
{
	const uint32_t seen = *context & 1023;
	int32_t p = (int32_t)(*context >> 10);
	p += (int32_t)(((int64_t)((int32_t)(bit << MIXER_PROBABILITY_BITS) - p) * tables->rate[seen]) >> 16);
	p = p > (1 << MIXER_PROBABILITY_BITS) - 1 ? (1 << MIXER_PROBABILITY_BITS) - 1 : p;
	*context = (uint32_t)p << 10 | (seen < limit ? seen + 1 : seen);
}

/* One bit with the probability of a single context. */
static inline uint32_t mixed_bit_alone(struct mixed_coder *coder, int decode, mixer_context *context, uint32_t bit)
{
	uint32_t p = *context >> 16;
	p = p < 16 ? 16 : p > 65520 ? 65520 : p;
	if (decode)
		bit = range_decode_with(&coder->decoder, 65536 - p);
	else
		range_encode_with(coder->encoder, 65536 - p, bit);
	mixer_context_learn(coder->tables, context, bit, MIXER_SEEN_MAX_ALONE);
	return bit;
}

/* One bit by the mix of four contexts; the four may coincide. */
static inline uint32_t mixed_bit(struct mixed_coder *coder, int decode, mixer_context *const context[MIXER_INPUTS],
                                 struct mixer_weights *weights, uint32_t bit)
{
	const struct mixer_tables *tables = coder->tables;
	int32_t input[MIXER_INPUTS];
	int64_t sum = 0;

	for (int i = 0; i < MIXER_INPUTS; i++) {
		input[i] = tables->stretch[*context[i] >> 20];
		sum += (int64_t)weights->w[i] * input[i];
	}
	sum >>= 16;
	sum = sum < -2047 ? -2047 : sum > 2047 ? 2047 : sum;
	const uint32_t p = tables->squash[sum + 2048];
	if (decode)
		bit = range_decode_with(&coder->decoder, 65536 - p);
	else
		range_encode_with(coder->encoder, 65536 - p, bit);
	const int32_t miss = (int32_t)(bit << 16) - (int32_t)p;
	for (int i = 0; i < MIXER_INPUTS; i++) {
		const int32_t w = weights->w[i] + ((input[i] * miss + (1 << 14)) >> 15);
		weights->w[i] = w < -MIXER_WEIGHT_MAX ? -MIXER_WEIGHT_MAX : w > MIXER_WEIGHT_MAX ? MIXER_WEIGHT_MAX : w;
		mixer_context_learn(tables, context[i], bit, MIXER_SEEN_MAX);
	}
	return bit;
}

#endif
