#include <math.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "compact.h"
#include "model/spectral/spectral.h"
#include "model/math/kernels.h"

/* A table's unit: what is beyond a float's range is cut. */
static float table_unit(double unit) { return (float)(unit < TABLE_LARGEST ? unit : TABLE_LARGEST); }

static float largest_value(const struct expansion *e)
{
	const size_t cells = lattice_cells(e->dims);
	int32_t largest = 0; /* as integers, which have the order of floats that are not negative, this vectorises */

	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < cells; n++) {
			const int32_t bits = (int32_t)bits_of_float(e->rgb[c][n]);
			largest = bits > largest ? bits : largest;
		}
	return float_of_bits((uint32_t)largest);
}

static bp_status expanded_alloc(struct table *t, bp_error *error)
{
	const struct lattice_dims d = t->dims;
	t->row = (d.phi_d + 1) * (uint32_t)t->channels;
	t->slice = t->row * d.theta_d;
	return table_store_alloc(t, (size_t)t->slice * d.theta_h * sizeof(uint16_t), error);
}

/* The cell behind each row's last: its first again. */
static void expanded_close(struct table *t)
{
	uint16_t *row = (uint16_t *)(void *)t->store;
	const size_t rows = (size_t)t->dims.theta_h * t->dims.theta_d, channels = (size_t)t->channels;
	for (size_t r = 0; r < rows; r++, row += t->row)
		memcpy(row + channels * t->dims.phi_d, row, channels * sizeof *row);
}

static bp_status expanded_fill(struct table *t, const struct expansion *e, float largest, bp_error *error)
{
	bp_status status = expanded_alloc(t, error);
	if (status)
		return status;
	/* A power of two times the expansion's unit: values keep their bits, and a table may be made before its largest is known. */
	int exponent;
	frexpf(largest, &exponent);
	const float factor = largest >= 0x1p-125f ? ldexpf(1, -exponent) : 0;
	t->unit = table_unit(ldexp(e->unit, exponent));
	uint16_t *to = (uint16_t *)(void *)t->store;
	size_t rows = (size_t)e->dims.theta_h * e->dims.theta_d, width = e->dims.phi_d;
	for (size_t r = 0; r < rows; r++, to += t->row) {
		const float *red = e->rgb[0] + r * width, *green = e->rgb[1] + r * width, *blue = e->rgb[2] + r * width;
		if (t->channels == 3) {
			for (size_t k = 0; k < width; k++) {
				to[3 * k] = table_encode(red[k] * factor);
				to[3 * k + 1] = table_encode(green[k] * factor);
				to[3 * k + 2] = table_encode(blue[k] * factor);
			}
		} else {
			for (size_t k = 0; k < width; k++)
				to[k] = table_encode((red[k] * factor + green[k] * factor + blue[k] * factor) * (1.0f / 3));
		}
	}
	expanded_close(t);
	return BP_OK;
}

/* Without its store. */
static bp_status table_new(struct lattice_dims dims, bool half, enum table_form form, int channels, struct table **out,
                           bp_error *error)
{
	struct table *t = memory_alloc_kept(sizeof *t);
	if (!t)
		return error_memory(error, sizeof *t);
	*t = (struct table){0};
	t->form = form;
	t->channels = channels;
	t->dims = dims;
	t->scale = lattice_scale_of(t->dims);
	const float shift = 1 - (half ? CENTRE_OF_HALF : CENTRE);
	t->shift = (f32x4){shift, shift, shift, 0};
	t->last = (f32x4){(float)t->dims.theta_h - 0.5f, (float)t->dims.theta_d - 0.5f, (float)t->dims.phi_d, 0};
	bool avx2 = kernels_avx2_usable();
	if (form == TABLE_COMPACT)
		t->kernels = (avx2 ? table_compact_avx2 : table_compact_plain)[channels == 3];
	else
		t->kernels = (avx2 ? table_expanded_avx2 : table_expanded_plain)[channels == 3];
	*out = t;
	return BP_OK;
}

/* half: the expansion holds every second value of another. */
static bp_status expansion_build(const struct expansion *expansion, bool half, enum table_form form, int channels,
                                 struct table **out, bp_error *error)
{
	if (!lattice_dims_legal(expansion->dims) || (channels != 1 && channels != 3) ||
	    (form != TABLE_EXPANDED && form != TABLE_COMPACT))
		return error_argument(error, "no such form of table (form %d, %d channels)", (int)form, channels);
	struct table *t = NULL;
	bp_status status = table_new(expansion->dims, half, form, channels, &t, error);
	if (status)
		return status;
	const float largest = largest_value(expansion);
	t->unit = table_unit(largest * expansion->unit);
	status = (form == TABLE_COMPACT ? compact_fill : expanded_fill)(t, expansion, largest, error);
	if (status)
		table_free(t);
	else
		*out = t;
	return status;
}

bp_status table_build(const struct expansion *expansion, enum table_form form, int channels, struct table **out, bp_error *error)
{
	return expansion_build(expansion, false, form, channels, out, error);
}

/* ---- from a model ---- */

/* Straight from the fields: no table of floats in between, which would be twice the size. */
static bp_status codes_build(const struct model *model, struct lattice_dims dims, bool half, int channels, struct table **out,
                             bp_error *error)
{
	struct table *table = NULL;
	bp_status status = table_new(dims, half, TABLE_EXPANDED, channels, &table, error);
	if (status)
		return status;
	table->unit = (float)(model->spectral->unit * SPECTRAL_CODES_UNIT);
	status = expanded_alloc(table, error);
	if (!status)
		status = spectral_expand_codes(model->spectral, model->layer_count, half, channels, (uint16_t *)(void *)table->store,
		                               table->row, error);
	if (status) {
		table_free(table);
		return status;
	}
	expanded_close(table);
	*out = table;
	return BP_OK;
}

bp_status table_build_model(const struct model *model, bool half, enum table_form form, int channels, struct table **out,
                            bp_error *error)
{
	const struct spectral_model *m = model->profile == PROFILE_SPECTRAL ? model->spectral : NULL;
	struct lattice_dims dims = model->dims;
	struct expansion expansion = {0};

	if (half && !model_has_half(model->dims, &dims))
		return error_argument(error, "the extents %u x %u x %u have no halves", dims.theta_h, dims.theta_d, dims.phi_d);
	if (m && form == TABLE_EXPANDED && (channels == 1 || channels == 3) && m->unit >= 0x1p-60 && m->unit <= 0x1p60)
		return codes_build(model, dims, half, channels, out, error);
	bp_status status = half ? model_expand_half(model, &expansion, error) : model_expand(model, 0, &expansion, error);
	if (!status)
		status = expansion_build(&expansion, half, form, channels, out, error);
	expansion_free(&expansion);
	return status;
}

void table_free(struct table *table)
{
	if (!table)
		return;
	memory_free_kept(table->store);
	memory_free_kept(table);
}

size_t table_bytes(const struct table *table) { return sizeof *table + table->store_bytes; }

bool table_layout(const struct table *table, struct table_layout *out)
{
	if (table->form != TABLE_COMPACT || table->channels != 3)
		return false;
	*out = (struct table_layout){
		.blocks = table->store,
		.bytes = (size_t)table->dims.theta_h * table->slice,
		.dims = table->dims,
		.row = table->row,
		.slice = table->slice,
		.width = table->width,
		.half = table->half,
		.first = 1 - table->shift[0],
	};
	for (int n = 0; n < 3; n++)
		for (int c = 0; c < 3; c++)
			out->mix[n][c] = table->mix[n][c];
	return true;
}

void table_evaluate(const struct table *table, const float wi[3], const float wo[3], float rgb[3])
{
	table->kernels.evaluate(table, wi, wo, rgb);
}

void table_nearest(const struct table *table, const float wi[3], const float wo[3], float rgb[3])
{
	table->kernels.nearest(table, wi, wo, rgb);
}

void table_evaluate_batch(const struct table *table, size_t count, const float *const wi[3], const float *const wo[3],
                          float *const rgb[3])
{
	table->kernels.batch(table, count, wi, wo, rgb);
}
