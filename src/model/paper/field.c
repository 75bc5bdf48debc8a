#include "field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "model/math/fill.h"
#include "model/math/select.h"

enum { LEVEL_MAX = 32767, REFINEMENTS_PAIR = 8, REFINEMENTS_SLICE = 0 };

struct field_codec {
	enum wavelet kind;
	struct wavelet_axis rows, columns;
	size_t cells;      /* of the plane */
	struct fill *fill;
	double *plane, *scratch, *wanted;
	float *smooth;
	uint8_t *defined;
};

bp_status field_codec_create(enum wavelet kind, uint32_t rows, uint32_t columns, struct field_codec **out, bp_error *error)
{
	struct field_codec *codec = calloc(1, sizeof *codec);

	if (!codec)
		return error_memory(error, sizeof *codec);
	codec->kind = kind;
	codec->rows = wavelet_axis_for(rows);
	codec->columns = wavelet_axis_for(columns);
	codec->cells = (size_t)codec->rows.plane * codec->columns.plane;
	codec->plane = malloc(codec->cells * sizeof *codec->plane);
	codec->scratch = malloc(codec->cells * sizeof *codec->scratch);
	codec->wanted = malloc(codec->cells * sizeof *codec->wanted);
	codec->smooth = malloc(codec->cells * sizeof *codec->smooth);
	codec->defined = malloc(codec->cells);
	bp_status status = fill_create(codec->rows.plane, codec->columns.plane, true, true, &codec->fill, error);
	if (!status && (!codec->plane || !codec->scratch || !codec->wanted || !codec->smooth || !codec->defined))
		status = error_memory(error, codec->cells * (3 * sizeof(double) + sizeof(float) + 1));
	if (status)
		field_codec_free(codec);
	else
		*out = codec;
	return status;
}

void field_codec_free(struct field_codec *codec)
{
	if (!codec)
		return;
	fill_free(codec->fill);
	free(codec->plane);
	free(codec->scratch);
	free(codec->wanted);
	free(codec->smooth);
	free(codec->defined);
	free(codec);
}

/* Is the field 1 within the tolerance? */
static bool is_one(const double *value, const uint8_t *defined, size_t n, double tolerance)
{
	double squares = 0;
	size_t count = 0;

	for (size_t i = 0; i < n; i++) {
		double d = defined[i] ? value[i] - 1 : 0;
		squares += d * d;
		count += defined[i];
	}
	return !(squares > tolerance * tolerance * (double)count);
}

/* Lays the field out on its plane: wanted and defined, the rest filled. */
static void plane_fill(struct field_codec *codec, const double *value, const uint8_t *defined)
{
	const size_t width = codec->columns.plane;

	memset(codec->defined, 0, codec->cells);
	for (size_t r = 0; r < codec->rows.field; r++)
		for (size_t c = 0; c < codec->columns.field; c++) {
			const size_t from = r * codec->columns.field + c, to = r * width + c;
			codec->defined[to] = defined[from];
			codec->wanted[to] = value[from] < FIELD_VALUE_MAX ? value[from] : FIELD_VALUE_MAX;
			codec->smooth[to] = (float)codec->wanted[to];
		}
	fill_plane(codec->fill, codec->smooth, codec->defined, 1);
	for (size_t i = 0; i < codec->cells; i++)
		codec->plane[i] = codec->defined[i] ? codec->wanted[i] : (double)codec->smooth[i];
}

/* Magnitudes this near to each other are equal: which of them is the larger is for rounding to say, and a table multiplied would be another. */
static const double EQUAL = 1e-7;

/* The magnitude of the last of the `keep` largest coefficients; *ties of those equal to it are among them. */
static double threshold_of(struct field_codec *codec, uint32_t keep, size_t *ties)
{
	size_t above = 0;

	for (size_t i = 0; i < codec->cells; i++)
		codec->scratch[i] = fabs(codec->plane[i]);
	double threshold = select_kth(codec->scratch, codec->cells, codec->cells - keep);
	for (size_t i = codec->cells - keep; i < codec->cells; i++)
		above += codec->scratch[i] > threshold * (1 + EQUAL);
	*ties = keep - above;
	return threshold;
}

/* Zeroes all but the `keep` largest coefficients; of equal ones, those of lower index stay. */
static void plane_thin(struct field_codec *codec, uint32_t keep)
{
	size_t ties;
	double threshold = threshold_of(codec, keep, &ties);

	for (size_t i = 0; i < codec->cells; i++) {
		double magnitude = fabs(codec->plane[i]);
		if (magnitude > threshold * (1 + EQUAL))
			continue;
		if (magnitude >= threshold * (1 - EQUAL) && ties)
			ties--;
		else
			codec->plane[i] = 0;
	}
}

static bp_status plane_quantise(const struct field_codec *codec, uint32_t keep, struct sparse_field *out, bp_error *error)
{
	double largest = 0;

	for (size_t i = 0; i < codec->cells; i++)
		largest = fmax(largest, fabs(codec->plane[i]));
	out->step = (float)(largest / LEVEL_MAX);
	if (!(out->step > 0)) /* all 0: one level of 0 would not be legal, so the least step stands for it */
		out->step = 1e-30f;
	out->index = malloc(keep * sizeof *out->index);
	out->level = malloc(keep * sizeof *out->level);
	if (!out->index || !out->level)
		return error_memory(error, keep * (sizeof *out->index + sizeof *out->level));
	for (size_t i = 0; i < codec->cells; i++) {
		if (codec->plane[i] == 0)
			continue;
		long level = lrint(codec->plane[i] / (double)out->step);
		level = level > LEVEL_MAX ? LEVEL_MAX : level < -LEVEL_MAX ? -LEVEL_MAX : level;
		if (!level)
			continue;
		out->index[out->count] = (uint32_t)i;
		out->level[out->count++] = (int16_t)level;
	}
	if (!out->count) { /* a field of zeros is not a field of ones */
		out->index[0] = 0;
		out->level[0] = 1;
		out->count = 1;
	}
	return BP_OK;
}

bp_status field_fit(struct field_codec *codec, const double *value, const uint8_t *defined, uint32_t keep, double tolerance,
                    struct sparse_field *out, bp_error *error)
{
	*out = (struct sparse_field){.rows = codec->rows.field, .columns = codec->columns.field};
	if (is_one(value, defined, (size_t)out->rows * out->columns, tolerance))
		return BP_OK;
	keep = keep ? keep : 1;
	plane_fill(codec, value, defined);
	for (int pass = 0;; pass++) {
		wavelet_forward(codec->kind, codec->rows, codec->columns, codec->plane, codec->scratch);
		plane_thin(codec, keep);
		if (pass == (codec->kind == WAVELET_HAAR ? REFINEMENTS_PAIR : REFINEMENTS_SLICE))
			break;
		wavelet_inverse(codec->kind, codec->rows, codec->columns, codec->plane, codec->scratch);
		for (size_t i = 0; i < codec->cells; i++)
			codec->plane[i] = codec->defined[i] ? codec->wanted[i] : codec->plane[i];
	}
	return plane_quantise(codec, keep, out, error);
}

void field_expand(struct field_codec *codec, const struct sparse_field *field, float *value)
{
	const size_t columns = codec->columns.field;

	if (!field->count) {
		for (size_t i = 0; i < codec->rows.field * columns; i++)
			value[i] = 1;
		return;
	}
	memset(codec->plane, 0, codec->cells * sizeof *codec->plane);
	for (uint32_t i = 0; i < field->count; i++)
		if (field->index[i] < codec->cells)
			codec->plane[field->index[i]] = (double)field->level[i] * (double)field->step;
	wavelet_inverse(codec->kind, codec->rows, codec->columns, codec->plane, codec->scratch);
	for (size_t r = 0; r < codec->rows.field; r++)
		for (size_t c = 0; c < columns; c++) {
			double v = codec->plane[r * codec->columns.plane + c];
			v = v > 0 ? v : 0;
			value[r * columns + c] = (float)(v < FIELD_VALUE_MAX ? v : FIELD_VALUE_MAX);
		}
}
