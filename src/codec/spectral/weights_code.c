#include "weights_code.h"

#include <string.h>

#include "codec/range_coder.h"

enum { EDGE = SPECTRAL_WEIGHTS_EDGE, PLAIN = SPECTRAL_WEIGHTS_EDGE_PLAIN * SPECTRAL_WEIGHTS_EDGE_PLAIN };

/* The median of left, upper, and the plane through these and the upper left (LOCO-I; Weinberger, Seroussi and Sapiro 2000). */
static int32_t likely(const uint8_t *weight, uint32_t n)
{
	if (n < EDGE)
		return n ? weight[n - 1] : 0;
	if (n % EDGE == 0)
		return weight[n - EDGE];
	const int32_t left = weight[n - 1], up = weight[n - EDGE], corner = weight[n - EDGE - 1];
	const int32_t most = left > up ? left : up, least = left + up - most;
	return corner >= most ? least : corner <= least ? most : left + up - corner;
}

static void model_reset(struct gamma_model *model)
{
	bit_models_reset((struct bit_model *)model, sizeof *model / sizeof(struct bit_model));
}

void weights_encode(const struct spectral_weights *weights, struct byte_buffer *out)
{
	struct range_encoder encoder;
	struct gamma_model model;

	if (!weights->graded) {
		write_bytes(out, weights->weight, PLAIN);
		return;
	}
	model_reset(&model);
	range_encoder_start(&encoder, out);
	for (uint32_t n = 0; n < SPECTRAL_WEIGHTS; n++) {
		const int32_t off = weights->weight[n] - likely(weights->weight, n);
		gamma_encode(&encoder, &model, (uint32_t)(off < 0 ? -2 * off - 1 : 2 * off));
	}
	range_encoder_end(&encoder);
}

const char *weights_decode(const uint8_t *bytes, size_t count, struct spectral_weights *weights)
{
	struct range_decoder decoder;
	struct gamma_model model;

	if (!weights->graded) {
		if (count != PLAIN)
			return "the section's bytes are not those of 100 weights";
		memcpy(weights->weight, bytes, PLAIN);
		return NULL;
	}
	model_reset(&model);
	range_decoder_start(&decoder, bytes, count);
	for (uint32_t n = 0; n < SPECTRAL_WEIGHTS; n++) {
		const int32_t off = (int32_t)gamma_decode(&decoder, &model);
		const int32_t weight = likely(weights->weight, n) + (off % 2 ? -(off / 2) - 1 : off / 2);
		if (weight < 0 || weight > SPECTRAL_WEIGHT_MOST)
			return "a weight is not from 0 to 63";
		weights->weight[n] = (uint8_t)weight;
	}
	return range_decoder_ended(&decoder) ? NULL : "the weights do not end where their section does";
}
