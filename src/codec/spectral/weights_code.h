/*
 * weights_code.h: a model's weights as bytes (FORMAT.md, "Fields"): as they are where it is not graded, else each as its
 * difference from what those before it make likely, range coded.
 */
#ifndef CODEC_SPECTRAL_WEIGHTS_CODE_H
#define CODEC_SPECTRAL_WEIGHTS_CODE_H

#include "bytes.h"
#include "model/spectral/spectral.h"

/* Appends to *out. */
void weights_encode(const struct spectral_weights *weights, struct byte_buffer *out);

/* weights->graded is set by the caller. NULL, or what is wrong: then the weights mean nothing. */
const char *weights_decode(const uint8_t *bytes, size_t count, struct spectral_weights *weights);

#endif
