/*
 * bit_mixer.h: predicts a bit from one context, from two, or from four. Every context has an adaptive probability. Two are
 * averaged; four are weighed by a small online regression in the logistic domain (Mattern 2012; the PAQ coders of Mahoney), which
 * takes three times as long. Integers only; FORMAT.md, "Mixed bits".
 */
#ifndef CODEC_BIT_MIXER_H
#define CODEC_BIT_MIXER_H

#include <stdint.h>
#include <string.h>

#include "range_coder.h"

enum { MIXER_INPUTS = 4, MIXER_PROBABILITY_BITS = 22 };

/* A probability of 1 in the upper 22 bits, and how many bits it has seen (up to a limit) in the lower 10. */
typedef uint32_t mixer_context;
#define MIXER_CONTEXT_EVEN (UINT32_C(1) << 31)

/* Weights in units of 1/65536. */
struct mixer_weights {
	int32_t w[MIXER_INPUTS];
};
enum {
	MIXER_WEIGHT_START = 19661,
	MIXER_WEIGHT_MAX = (1 << 18) - 1,
	MIXER_SEEN_MAX_ALONE = 250,
	MIXER_SEEN_MAX_PAIR = 40,
	MIXER_SEEN_MAX = 60
};

/* The four inputs side by side. All sums and products of the mixer fit 32 bits; FORMAT.md has the bounds. */
typedef int32_t mixer_lanes __attribute__((vector_size(4 * MIXER_INPUTS)));
typedef uint32_t mixer_words __attribute__((vector_size(4 * MIXER_INPUTS)));

/* Tables, the same for all: stretch[i] = ln(p/(1-p)) of p = (i + 1/2)/4096, and its inverse, with 8 bits behind the point. */
struct mixer_tables {
	int16_t stretch[4096];
	uint16_t squash[4096];
	uint32_t rate[256]; /* how far a context that has seen n bits moves: 65536/(n + 1.6), at most 32767 */
};
const struct mixer_tables *mixer_tables_get(void); /* thread-safe */

/* Encoder or decoder, whichever is set. */
struct mixed_coder {
	struct range_encoder *encoder;
	struct range_decoder decoder;
	const struct mixer_tables *tables;
};

/* p + floor((2^22 - p) / 64) rate / 1024 or p - floor(p / 64) rate / 1024, both where p stands in the context; p is never 0. */
static inline mixer_context mixer_context_learnt(const struct mixer_tables *tables, mixer_context state, uint32_t bit,
                                                 uint32_t limit)
{
	const uint32_t seen = state & 1023, rate = tables->rate[seen], more = seen < limit;
	if (bit)
		return state + (((seen - state) >> 16) * rate & ~UINT32_C(1023)) + more;
	return state - ((state >> 16) * rate & ~UINT32_C(1023)) + more;
}

/* One bit of which q / 65536 is the probability of being 1; a certainty is not believed. */
static inline uint32_t mixed_bit_with(struct mixed_coder *coder, int decode, uint32_t q, uint32_t bit)
{
	q = q < 16 ? 16 : q > 65520 ? 65520 : q;
	if (decode)
		return range_decode_with(&coder->decoder, 65536 - q);
	range_encode_with(coder->encoder, 65536 - q, bit);
	return bit;
}

static inline uint32_t mixed_bit_alone(struct mixed_coder *coder, int decode, mixer_context *context, uint32_t bit)
{
	const mixer_context state = *context;
	bit = mixed_bit_with(coder, decode, state >> 16, bit);
	*context = mixer_context_learnt(coder->tables, state, bit, MIXER_SEEN_MAX_ALONE);
	return bit;
}

/* One bit by the average of two contexts, not the same. */
static inline uint32_t mixed_bit_pair(struct mixed_coder *coder, int decode, mixer_context *first, mixer_context *second,
                                      uint32_t bit)
{
	const mixer_context a = *first, b = *second;
	bit = mixed_bit_with(coder, decode, ((a >> 10) + (b >> 10)) >> 7, bit);
	*first = mixer_context_learnt(coder->tables, a, bit, MIXER_SEEN_MAX_PAIR);
	*second = mixer_context_learnt(coder->tables, b, bit, MIXER_SEEN_MAX_PAIR);
	return bit;
}

/* One bit by the mix of four contexts, no two of them the same. */
static inline uint32_t mixed_bit(struct mixed_coder *coder, int decode, mixer_context *const context[MIXER_INPUTS],
                                 struct mixer_weights *weights, uint32_t bit)
{
	const struct mixer_tables *tables = coder->tables;
	const mixer_words state = {*context[0], *context[1], *context[2], *context[3]};
	const mixer_lanes input = {tables->stretch[*context[0] >> 20], tables->stretch[*context[1] >> 20],
	                           tables->stretch[*context[2] >> 20], tables->stretch[*context[3] >> 20]};
	const mixer_words rate = {tables->rate[*context[0] & 1023], tables->rate[*context[1] & 1023],
	                          tables->rate[*context[2] & 1023], tables->rate[*context[3] & 1023]};
	mixer_lanes w;

	memcpy(&w, weights->w, sizeof w);
	const mixer_lanes part = w * input;
	int32_t sum = (part[0] + part[1] + part[2] + part[3]) >> 16;
	sum = sum < -2047 ? -2047 : sum > 2047 ? 2047 : sum;
	const uint32_t q = tables->squash[sum + 2048];
	bit = mixed_bit_with(coder, decode, q, bit);

	w += (input * ((int32_t)(bit << 16) - (int32_t)q) + (1 << 14)) >> 15;
	const mixer_lanes high = w > MIXER_WEIGHT_MAX, low = w < -MIXER_WEIGHT_MAX;
	w = (w & ~(high | low)) | (high & MIXER_WEIGHT_MAX) | (low & -MIXER_WEIGHT_MAX);
	memcpy(weights->w, &w, sizeof w);

	/* mixer_context_learnt of all four: towards 2^22 where the bit is 1, towards 0 where it is 0. */
	const uint32_t zero = bit - 1;
	const mixer_words seen = state & 1023, step = (((seen - state) & ~zero) | (state & zero)) >> 16;
	const mixer_words move = step * rate & ~UINT32_C(1023);
	const mixer_words learnt = state + ((move ^ zero) - zero) - (mixer_words)((mixer_lanes)seen < MIXER_SEEN_MAX);
	for (int i = 0; i < MIXER_INPUTS; i++)
		*context[i] = learnt[i];
	return bit;
}

#endif
