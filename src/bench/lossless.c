/*
 * lossless.c: zlib, zstd and xz on the whole measured file, for scale: what is left when nothing may be lost.
 */
#include <lzma.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include <zstd.h>

#include "error.h"
#include "merl/merl_file.h"
#include "baseline.h"

enum { ZLIB_LEVEL = 6, ZSTD_LEVEL = 9, XZ_LEVEL = 0 };
enum { HEADER_BYTES = 12 };

struct codec {
	size_t (*bound)(size_t bytes);
	/* Both return the bytes written, 0 on failure. */
	size_t (*compress)(const uint8_t *in, size_t bytes, uint8_t *out, size_t capacity);
	size_t (*decompress)(const uint8_t *in, size_t bytes, uint8_t *out, size_t capacity);
};

struct lossless_state {
	const struct codec *codec;
	size_t plain_bytes, bytes;
	uint8_t *stream;
};

static size_t zlib_bound(size_t bytes) { return compressBound(bytes); }

static size_t zlib_compress(const uint8_t *in, size_t bytes, uint8_t *out, size_t capacity)
{
	uLongf size = capacity;

	return compress2(out, &size, in, bytes, ZLIB_LEVEL) == Z_OK ? size : 0;
}

static size_t zlib_decompress(const uint8_t *in, size_t bytes, uint8_t *out, size_t capacity)
{
	uLongf size = capacity;

	return uncompress(out, &size, in, bytes) == Z_OK ? size : 0;
}

static size_t zstd_compress(const uint8_t *in, size_t bytes, uint8_t *out, size_t capacity)
{
	size_t size = ZSTD_compress(out, capacity, in, bytes, ZSTD_LEVEL);

	return ZSTD_isError(size) ? 0 : size;
}

static size_t zstd_decompress(const uint8_t *in, size_t bytes, uint8_t *out, size_t capacity)
{
	size_t size = ZSTD_decompress(out, capacity, in, bytes);

	return ZSTD_isError(size) ? 0 : size;
}

static size_t xz_compress(const uint8_t *in, size_t bytes, uint8_t *out, size_t capacity)
{
	size_t at = 0;

	return lzma_easy_buffer_encode(XZ_LEVEL, LZMA_CHECK_CRC32, NULL, in, bytes, out, &at, capacity) == LZMA_OK ? at : 0;
}

static size_t xz_decompress(const uint8_t *in, size_t bytes, uint8_t *out, size_t capacity)
{
	uint64_t memory = UINT64_MAX;
	size_t from = 0, to = 0;

	return lzma_stream_buffer_decode(&memory, 0, NULL, in, &from, bytes, out, &to, capacity) == LZMA_OK ? to : 0;
}

static const struct codec ZLIB = {zlib_bound, zlib_compress, zlib_decompress};
static const struct codec ZSTD = {ZSTD_compressBound, zstd_compress, zstd_decompress};
static const struct codec XZ = {lzma_stream_buffer_bound, xz_compress, xz_decompress};

static void lossless_free(void *opaque)
{
	struct lossless_state *state = opaque;

	if (state)
		free(state->stream);
	free(state);
}

static bp_status lossless_fit(const struct baseline *self, const struct bench_material *material, struct fitted *out,
                              bp_error *error)
{
	const struct codec *codec = self->variant;
	const size_t capacity = codec->bound(material->raw_bytes);
	struct lossless_state *state = calloc(1, sizeof *state);
	bp_status status = BP_OK;

	if (!state)
		return error_memory(error, sizeof *state);
	if (material->raw_bytes != merl_file_bytes(material->lattice->dims)) {
		free(state);
		return error_set(error, BP_ERROR_UNSUPPORTED, BP_NO_OFFSET, "not a MERL file");
	}
	*state = (struct lossless_state){.codec = codec, .plain_bytes = material->raw_bytes, .stream = malloc(capacity)};
	if (!state->stream)
		status = error_memory(error, capacity);
	else if (!(state->bytes = codec->compress(material->raw, material->raw_bytes, state->stream, capacity)))
		status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "the codec refused the table");
	if (status)
		lossless_free(state);
	else
		*out = (struct fitted){.state = state, .bytes = state->bytes};
	return status;
}

/* Invalid cells become 0. */
static bp_status lossless_expand(const void *opaque, struct expansion *out, bp_error *error)
{
	const struct lossless_state *state = opaque;
	const size_t cells = lattice_cells(out->dims);
	uint8_t *plain = malloc(state->plain_bytes);

	if (!plain)
		return error_memory(error, state->plain_bytes);
	if (state->codec->decompress(state->stream, state->bytes, plain, state->plain_bytes) != state->plain_bytes) {
		free(plain);
		return error_set(error, BP_ERROR_CORRUPT, BP_NO_OFFSET, "the codec could not decode its own stream");
	}
	out->unit = 1;
	for (size_t c = 0; c < 3; c++)
		for (size_t cell = 0; cell < cells; cell++) {
			double value;
			memcpy(&value, plain + HEADER_BYTES + (c * cells + cell) * sizeof value, sizeof value);
			out->rgb[c][cell] = value > 0 ? (float)(value * MERL_SCALE[c]) : 0;
		}
	free(plain);
	return BP_OK;
}

#define LOSSLESS(text, codec) \
	{ \
		.reference = text, .variant = &codec, .fit = lossless_fit, .expand = lossless_expand, .free_state = lossless_free \
	}

const struct baseline BASELINE_ZLIB = LOSSLESS("zlib " ZLIB_VERSION ", level 6, lossless", ZLIB);
const struct baseline BASELINE_ZSTD = LOSSLESS("zstd " ZSTD_VERSION_STRING ", level 9, lossless", ZSTD);
const struct baseline BASELINE_XZ = LOSSLESS("xz " LZMA_VERSION_STRING ", preset 0, lossless", XZ);
