/* paper_expand.c: the paper's model becomes a table; the inverse of paper_fit.c. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "paper.h"
#include "paper_kernels.h"

/* ---- fields ---- */

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

/* ---- slices ---- */

/* Everything that a slice needs, expanded once. */
struct slices {
	struct lattice_dims dims;
	const struct paper_channel *channel;
	bool with_slices;
	float *hd, *hphi;          /* c_hd, c_hphi; all 1 where not loaded. hd owns all arrays */
	struct field_codec *codec; /* of c_dphi|h */
	float *dphi;               /* the slice's c_dphi|h */
	bool dphi_is_one;
	float *column; /* f_phi c_hphi of the slice */
};

/* Values stay below this, in 1/sr: in a MERL file they are up to 1500 times as large. Only hostile records come near. */
static const double VALUE_MAX = 1e304;

/* Factors stay below this, so that no product of them leaves the range of float. */
static const float FACTOR_MAX = 1e15f;

static void slices_free(struct slices *s)
{
	free(s->hd);
	free(s->codec);
}

static bp_status pair_expand(struct lattice_dims dims, enum paper_field kind, const struct sparse_field *field, bool loaded,
                             float *out, bp_error *error)
{
	const struct sparse_field one = {.count = 0};
	struct field_codec *codec = NULL;
	const bp_status status = field_codec_create(dims, kind, &codec, error);
	if (!status)
		field_expand(codec, loaded ? field : &one, out);
	free(codec);
	return status;
}

static bp_status slices_begin(struct lattice_dims d, const struct paper_channel *channel, uint32_t layers, struct slices *s,
                              bp_error *error)
{
	const size_t hd = (size_t)d.theta_h * d.theta_d, hphi = (size_t)d.theta_h * d.phi_d, slice = (size_t)d.theta_d * d.phi_d;
	const size_t bytes = (hd + hphi + slice + d.phi_d) * sizeof(float);
	const bool pairs = layers > PAPER_LAYER_PAIRS;

	*s = (struct slices){.dims = d, .channel = channel, .with_slices = layers > PAPER_LAYER_SLICES && channel->slice_count};
	s->hd = malloc(bytes);
	if (!s->hd)
		return error_memory(error, bytes);
	s->hphi = s->hd + hd;
	s->dphi = s->hphi + hphi;
	s->column = s->dphi + slice;
	bp_status status = pair_expand(d, PAPER_HD, &channel->hd, pairs, s->hd, error);
	status = status ? status : pair_expand(d, PAPER_HPHI, &channel->hphi, pairs, s->hphi, error);
	return status ? status : field_codec_create(d, PAPER_SLICE, &s->codec, error);
}

/* Slice i of f_h f_d f_phi c_hd c_hphi c_dphi|h; slices must be asked for in ascending order from 0. */
static void slice_expand(struct slices *s, uint32_t i, float *out)
{
	const struct paper_kernels *kernels = paper_kernels_get();
	const struct paper_channel *channel = s->channel;
	const struct lattice_dims d = s->dims;
	const float h = channel->marginal[0][i], *hd = s->hd + (size_t)i * d.theta_d, *hphi = s->hphi + (size_t)i * d.phi_d;

	if (!s->with_slices) {
		s->dphi_is_one = true;
	} else if (i < channel->slice_count) { /* above, the last one stays */
		s->dphi_is_one = channel->slice[i].count == 0;
		if (!s->dphi_is_one)
			field_expand(s->codec, &channel->slice[i], s->dphi);
	}
	for (uint32_t k = 0; k < d.phi_d; k++)
		s->column[k] = fminf(channel->marginal[2][k] * hphi[k], FACTOR_MAX);
	for (uint32_t j = 0; j < d.theta_d; j++) {
		float row = fminf(h * channel->marginal[1][j], FACTOR_MAX);
		row = fminf(row * hd[j], FACTOR_MAX);
		kernels->paper_row(row, s->column, s->dphi_is_one ? NULL : s->dphi + (size_t)j * d.phi_d, d.phi_d,
		                   out + (size_t)j * d.phi_d);
	}
}

bp_status paper_channel_expand(struct lattice_dims dims, const struct paper_channel *channel, float *table, bp_error *error)
{
	struct slices s;
	bp_status status = slices_begin(dims, channel, PAPER_LAYERS, &s, error);

	for (uint32_t i = 0; !status && i < dims.theta_h; i++)
		slice_expand(&s, i, table + lattice_index(dims, i, 0, 0));
	slices_free(&s);
	return status;
}

/* A power of two beside the largest of |diffuse| and |specular| K of the channels, by exponents: the products may overflow. */
static int unit_exponent(const struct paper_model *paper, const struct colour_fit colour[3])
{
	int largest = -1000;

	for (int c = 0; c < 3; c++) {
		int scale_exponent, e;
		const double scale = frexp(paper->channel[c].scale, &scale_exponent);
		frexp(colour[c].diffuse, &e);
		largest = colour[c].diffuse != 0 && e > largest ? e : largest;
		frexp(colour[c].specular, &e);
		largest = colour[c].specular * scale != 0 && e + scale_exponent > largest ? e + scale_exponent : largest;
	}
	return largest > 1000 ? 1000 : largest;
}

/* Of a model with one channel alone, all have its values. */
static void channels_fill(const struct paper_model *paper, struct expansion *out)
{
	int there = 0;

	while (there < 2 && !paper->channel[there].marginal[0])
		there++;
	for (int c = 0; c < 3; c++)
		if (!paper->channel[c].marginal[0])
			memcpy(out->rgb[c], out->rgb[there], lattice_cells(out->dims) * sizeof(float));
}

bp_status paper_expand(const struct paper_model *paper, const struct colour_fit colour[3], uint32_t layers, struct expansion *out,
                       bp_error *error)
{
	const struct lattice_dims d = paper->dims;
	const size_t cells = (size_t)d.theta_d * d.phi_d;
	const int largest = unit_exponent(paper, colour);

	out->unit = ldexp(1, largest);
	const float limit = (float)fmin(VALUE_MAX / out->unit, 1e37);
	for (int c = 0; c < 3; c++) {
		const struct paper_channel *channel = &paper->channel[c];
		int scale_exponent;
		const double scale = frexp(channel->scale, &scale_exponent);
		const float diffuse = (float)ldexp(colour[c].diffuse, -largest);
		const float specular = (float)ldexp(colour[c].specular * scale, scale_exponent - largest);
		struct slices s;

		if (!channel->marginal[0])
			continue;
		bp_status status = slices_begin(d, channel, layers, &s, error);
		for (uint32_t i = 0; !status && i < d.theta_h; i++) {
			slice_expand(&s, i, out->rgb[c] + i * cells);
			paper_kernels_get()->paper_colour(diffuse, specular, limit, cells, out->rgb[c] + i * cells);
		}
		slices_free(&s);
		if (status)
			return status;
	}
	channels_fill(paper, out);
	return BP_OK;
}
