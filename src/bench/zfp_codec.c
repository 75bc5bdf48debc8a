/*
 * zfp_codec.c: P. Lindstrom, "Fixed-rate compressed floating-point arrays", 2014; the zfp library. The logarithm
 * (log_tensor.h) as three fields, its mean over the channels, R - G and B - G, each one 3-D float array in
 * fixed-accuracy mode; coding R, G and B themselves takes about three times the bytes. zfp's tolerance counts in
 * powers of two, so its sizes come in steps: the exponent whose size is nearest to the budget (in ratio) is taken.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <zfp.h>

#include "error.h"
#include "baseline.h"
#include "log_tensor.h"

enum { EXPONENT_MIN = -20, EXPONENT_MAX = 14 };

struct zfp_state {
	struct lattice_dims dims;
	int exponent;
	size_t bytes[3];
	uint8_t *stream[3];
};

static void zfp_state_free(void *opaque)
{
	struct zfp_state *state = opaque;

	for (int c = 0; state && c < 3; c++)
		free(state->stream[c]);
	free(state);
}

/* Codes or decodes one plane, or (bytes NULL) sizes up the room for coding it; returns the bytes of the stream, 0 on failure. */
static size_t run_plane(struct lattice_dims dims, float *plane, int exponent, uint8_t *bytes, size_t capacity, bool decode)
{
	zfp_field *field = zfp_field_3d(plane, zfp_type_float, dims.phi_d, dims.theta_d, dims.theta_h);
	zfp_stream *zfp = zfp_stream_open(NULL);
	bitstream *stream = bytes ? stream_open(bytes, capacity) : NULL;
	size_t size = 0;

	if (field && zfp)
		zfp_stream_set_accuracy(zfp, ldexp(1, exponent));
	if (field && zfp && !bytes)
		size = zfp_stream_maximum_size(zfp, field);
	if (field && zfp && stream) {
		zfp_stream_set_bit_stream(zfp, stream);
		zfp_stream_rewind(zfp);
		size = decode ? zfp_decompress(zfp, field) : zfp_compress(zfp, field);
	}
	if (stream)
		stream_close(stream);
	if (zfp)
		zfp_stream_close(zfp);
	if (field)
		zfp_field_free(field);
	return size;
}

/* R, G, B -> mean, R - G, B - G, in place. */
static void split_colour(struct log_tensor *tensor)
{
	const size_t cells = lattice_cells(tensor->dims);

	for (size_t cell = 0; cell < cells; cell++) {
		float r = tensor->plane[0][cell], g = tensor->plane[1][cell], b = tensor->plane[2][cell];
		tensor->plane[0][cell] = (r + g + b) / 3;
		tensor->plane[1][cell] = r - g;
		tensor->plane[2][cell] = b - g;
	}
}

static size_t total_size(const struct log_tensor *tensor, int exponent, uint8_t *scratch, size_t capacity)
{
	size_t sum = 0;

	for (int c = 0; c < 3; c++)
		sum += run_plane(tensor->dims, tensor->plane[c], exponent, scratch, capacity, false);
	return sum;
}

static bp_status zfp_fit(const struct baseline *self, const struct bench_material *material, struct fitted *out, bp_error *error)
{
	struct log_tensor tensor = {0};
	struct zfp_state *state = calloc(1, sizeof *state);
	uint8_t *scratch = NULL;
	const double budget = (double)material->budget_bytes;
	size_t capacity, high, low;
	int below = EXPONENT_MIN, above = EXPONENT_MAX;
	bp_status status;

	(void)self;
	if (!state)
		return error_memory(error, sizeof *state);
	if ((status = log_tensor_make(material->lattice, &tensor, error)))
		goto out;
	split_colour(&tensor);
	state->dims = tensor.dims;
	capacity = run_plane(tensor.dims, tensor.plane[0], EXPONENT_MIN, NULL, 0, false);
	scratch = malloc(capacity);
	if (!scratch || !capacity) {
		status = error_memory(error, capacity);
		goto out;
	}
	/* size falls as the exponent grows: size(below) > budget >= size(above), where the range allows */
	while (above - below > 1) {
		int middle = (above + below + 2 * 64) / 2 - 64; /* rounds down for negative sums too */
		if (total_size(&tensor, middle, scratch, capacity) > material->budget_bytes)
			below = middle;
		else
			above = middle;
	}
	high = total_size(&tensor, below, scratch, capacity);
	low = total_size(&tensor, above, scratch, capacity);
	state->exponent = (double)high / budget < budget / (double)low ? below : above;
	for (int c = 0; c < 3; c++) {
		state->bytes[c] = run_plane(tensor.dims, tensor.plane[c], state->exponent, scratch, capacity, false);
		/* the decoder may read a word past the end */
		state->stream[c] = calloc(1, state->bytes[c] + 8);
		if (!state->stream[c] || !state->bytes[c]) {
			status = error_set(error, BP_ERROR_MEMORY, BP_NO_OFFSET, "zfp could not code a plane");
			goto out;
		}
		memcpy(state->stream[c], scratch, state->bytes[c]);
	}
	*out = (struct fitted){.state = state, .bytes = state->bytes[0] + state->bytes[1] + state->bytes[2]};
	state = NULL;
out:
	log_tensor_free(&tensor);
	free(scratch);
	zfp_state_free(state);
	return status;
}

static bp_status zfp_expand(const void *opaque, struct expansion *out, bp_error *error)
{
	const struct zfp_state *state = opaque;
	const size_t cells = lattice_cells(state->dims);

	out->unit = 1;
	for (int c = 0; c < 3; c++)
		if (!run_plane(state->dims, out->rgb[c], state->exponent, state->stream[c], state->bytes[c] + 8, true))
			return error_set(error, BP_ERROR_CORRUPT, BP_NO_OFFSET, "zfp could not decode its own stream");
	for (size_t cell = 0; cell < cells; cell++) {
		float mean = out->rgb[0][cell], red = out->rgb[1][cell], blue = out->rgb[2][cell], green = mean - (red + blue) / 3;
		out->rgb[0][cell] = log_tensor_value(green + red);
		out->rgb[1][cell] = log_tensor_value(green);
		out->rgb[2][cell] = log_tensor_value(green + blue);
	}
	return BP_OK;
}

const struct baseline BASELINE_ZFP = {
	.reference = "zfp " ZFP_VERSION_STRING ", fixed accuracy, logarithm",
	.budgeted = true,
	.fit = zfp_fit,
	.expand = zfp_expand,
	.free_state = zfp_state_free,
};
