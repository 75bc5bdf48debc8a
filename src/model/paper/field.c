#include "field.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"

struct field_codec {
	struct wavelet_plane plane;
	size_t cells; /* of the plane */
	float least;
	float *scratch; /* behind the coefficients */
	float coefficient[];
};

bp_status field_codec_create(struct lattice_dims dims, enum paper_field kind, struct field_codec **out, bp_error *error)
{
	const struct wavelet_plane plane = paper_plane(dims, kind);
	const size_t cells = wavelet_cells(&plane), bytes = sizeof(struct field_codec) + 4 * cells * sizeof(float);
	struct field_codec *codec = malloc(bytes);

	if (!codec)
		return error_memory(error, bytes);
	codec->plane = plane;
	codec->cells = cells;
	codec->least = kind == PAPER_SLICE ? 0 : FIELD_PAIR_MIN;
	codec->scratch = codec->coefficient + cells;
	*out = codec;
	return BP_OK;
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
