/* paper_expand.c: the paper's model becomes a table; the inverse of paper_fit.c. */
#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "field.h"
#include "paper_kernels.h"
#include "paper.h"

/* Everything that a slice needs, expanded once. */
struct slices {
	struct lattice_dims dims;
	const struct paper_model *paper;
	uint32_t layers;
	float *hd, *hphi;          /* c_hd, c_hphi; all 1 where not loaded */
	struct field_codec *codec; /* of c_dphi|h */
	float *dphi;               /* the slice's c_dphi|h */
	bool dphi_is_one;
	float *column;             /* f_phi c_hphi of the slice */
};

/* Values stay below this, in 1/sr, so that they are finite in a MERL file too, which multiplies by 1500. Only hostile records come near. */
static const double VALUE_MAX = 1e304;

/* Factors stay below this, so that no product of them leaves the range of float. */
static const float FACTOR_MAX = 1e15f;

static void slices_free(struct slices *s)
{
	free(s->hd);
	free(s->hphi);
	free(s->dphi);
	free(s->column);
	field_codec_free(s->codec);
}

static bp_status pair_expand(const struct sparse_field *field, bool loaded, uint32_t rows, uint32_t columns, float **out, bp_error *error)
{
	const struct sparse_field one = {.rows = rows, .columns = columns};
	struct field_codec *codec = NULL;

	*out = malloc((size_t)rows * columns * sizeof **out);
	if (!*out)
		return error_memory(error, (size_t)rows * columns * sizeof **out);
	bp_status status = field_codec_create(WAVELET_HAAR, rows, columns, &codec, error);
	if (!status)
		field_expand(codec, loaded ? field : &one, *out);
	field_codec_free(codec);
	return status;
}

static bp_status slices_begin(const struct paper_model *paper, struct lattice_dims d, uint32_t layers, struct slices *s, bp_error *error)
{
	*s = (struct slices){.dims = d, .paper = paper, .layers = layers};
	bp_status status = pair_expand(&paper->hd, layers > PAPER_LAYER_PAIRS, d.theta_h, d.theta_d, &s->hd, error);
	status = status ? status : pair_expand(&paper->hphi, layers > PAPER_LAYER_PAIRS, d.theta_h, d.phi_d, &s->hphi, error);
	status = status ? status : field_codec_create(WAVELET_DAUBECHIES, d.theta_d, d.phi_d, &s->codec, error);
	if (status)
		return status;
	s->dphi = malloc((size_t)d.theta_d * d.phi_d * sizeof *s->dphi);
	s->column = malloc(d.phi_d * sizeof *s->column);
	return s->dphi && s->column ? BP_OK : error_memory(error, (size_t)d.theta_d * d.phi_d * sizeof *s->dphi);
}

/* Slice i of f_h f_d f_phi c_hd c_hphi c_dphi|h; slices must be asked for in ascending order from 0. */
static void slice_expand(struct slices *s, uint32_t i, float *out)
{
	const struct paper_kernels *kernels = paper_kernels_get();
	const struct paper_model *paper = s->paper;
	const struct lattice_dims d = s->dims;
	const float h = paper->marginal[0][i], *hd = s->hd + (size_t)i * d.theta_d, *hphi = s->hphi + (size_t)i * d.phi_d;

	if (s->layers > PAPER_LAYER_SLICES && paper->slice_count) {
		if (i < paper->slice_count) { /* above, the last one stays */
			s->dphi_is_one = paper->slice[i].count == 0;
			if (!s->dphi_is_one)
				field_expand(s->codec, &paper->slice[i], s->dphi);
		}
	} else {
		s->dphi_is_one = true;
	}
	for (uint32_t k = 0; k < d.phi_d; k++)
		s->column[k] = fminf(paper->marginal[2][k] * hphi[k], FACTOR_MAX);
	for (uint32_t j = 0; j < d.theta_d; j++) {
		float row = fminf(h * paper->marginal[1][j], FACTOR_MAX);
		row = fminf(row * hd[j], FACTOR_MAX);
		kernels->paper_row(row, s->column, s->dphi_is_one ? NULL : s->dphi + (size_t)j * d.phi_d, d.phi_d, out + (size_t)j * d.phi_d);
	}
}

bp_status paper_achromatic(const struct paper_model *paper, uint32_t layers, float *table, bp_error *error)
{
	const struct lattice_dims dims = paper->dims;
	struct slices s;
	bp_status status = slices_begin(paper, dims, layers, &s, error);

	for (uint32_t i = 0; !status && i < dims.theta_h; i++)
		slice_expand(&s, i, table + lattice_index(dims, i, 0, 0));
	slices_free(&s);
	return status;
}

bp_status paper_expand(const struct paper_model *paper, const struct colour_fit colour[3], uint32_t layers, struct expansion *out, bp_error *error)
{
	const struct paper_kernels *kernels = paper_kernels_get();
	const struct lattice_dims d = paper->dims;
	const size_t cells = (size_t)d.theta_d * d.phi_d;
	float diffuse[3], specular[3], *achromatic = NULL;
	struct slices s;
	int scale_exponent, largest = -1000;

	/* The unit is a power of two beside the larger of |diffuse| and |specular| K, by exponents: the product may overflow. */
	const double scale = frexp(paper->scale, &scale_exponent);
	for (int c = 0; c < 3; c++) {
		int e;
		frexp(colour[c].diffuse, &e);
		largest = colour[c].diffuse != 0 && e > largest ? e : largest;
		frexp(colour[c].specular, &e);
		largest = colour[c].specular * scale != 0 && e + scale_exponent > largest ? e + scale_exponent : largest;
	}
	largest = largest > 1000 ? 1000 : largest;
	out->unit = ldexp(1, largest);
	for (int c = 0; c < 3; c++) {
		diffuse[c] = (float)ldexp(colour[c].diffuse, -largest);
		specular[c] = (float)ldexp(colour[c].specular * scale, scale_exponent - largest);
	}
	const float limit = (float)fmin(VALUE_MAX / out->unit, 1e37);
	bp_status status = slices_begin(paper, d, layers, &s, error);
	if (status)
		goto out;
	achromatic = malloc(cells * sizeof *achromatic);
	if (!achromatic) {
		status = error_memory(error, cells * sizeof *achromatic);
		goto out;
	}
	for (uint32_t i = 0; i < d.theta_h; i++) {
		float *const rgb[3] = {out->rgb[0] + i * cells, out->rgb[1] + i * cells, out->rgb[2] + i * cells};

		slice_expand(&s, i, achromatic);
		kernels->paper_colour(achromatic, cells, diffuse, specular, limit, rgb);
	}
out:
	free(achromatic);
	slices_free(&s);
	return status;
}
