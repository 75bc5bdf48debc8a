#include "field.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "paper_plane.h"

struct field_codec {
	struct wavelet_plane plane;
	size_t cells; /* of the plane */
	float least;
	float *coefficient, *scratch;
};

bp_status field_codec_create(struct lattice_dims dims, enum paper_field kind, struct field_codec **out, bp_error *error)
{
	struct field_codec *codec = calloc(1, sizeof *codec);

	if (!codec)
		return error_memory(error, sizeof *codec);
	codec->plane = paper_plane(dims, kind);
	codec->cells = wavelet_cells(&codec->plane);
	codec->least = kind == PAPER_SLICE ? 0 : FIELD_PAIR_MIN;
	codec->coefficient = malloc(codec->cells * sizeof *codec->coefficient);
	codec->scratch = malloc(3 * codec->cells * sizeof *codec->scratch);
	if (!codec->coefficient || !codec->scratch) {
		const size_t cells = codec->cells;
		field_codec_free(codec);
		return error_memory(error, 4 * cells * sizeof(float));
	}
	*out = codec;
	return BP_OK;
}

void field_codec_free(struct field_codec *codec)
{
	if (!codec)
		return;
	free(codec->coefficient);
	free(codec->scratch);
	free(codec);
}

void field_expand(struct field_codec *codec, const struct sparse_field *field, float *value)
{
	const size_t n = wavelet_field_cells(&codec->plane);
	const float least = codec->least;

	if (!field->count) {
		for (size_t i = 0; i < n; i++)
			value[i] = 1;
		return;
	}
	const float step = paper_step(field->step);
	memset(codec->coefficient, 0, codec->cells * sizeof *codec->coefficient);
	for (uint32_t i = 0; i < field->count; i++)
		if (field->index[i] < codec->cells)
			codec->coefficient[field->index[i]] = (float)field->level[i] * step;
	wavelet_inverse(&codec->plane, codec->coefficient, value, codec->scratch);
	for (size_t i = 0; i < n; i++) {
		const float v = value[i] > least ? value[i] : least;
		value[i] = v < FIELD_VALUE_MAX ? v : FIELD_VALUE_MAX;
	}
}
