#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "../memory.h"
#include "compact.h"
#include "kernels.h"

static float largest_value(const struct expansion *e)
{
	size_t cells = lattice_cells(e->dims);
	float lane[16] = {0};
	for (int c = 0; c < 3; c++) {
		const float *plane = e->rgb[c];
		size_t n = 0;
		for (; n + 16 <= cells; n += 16)
			for (int m = 0; m < 16; m++)
				lane[m] = plane[n + (size_t)m] > lane[m] ? plane[n + (size_t)m] : lane[m];
		for (; n < cells; n++)
			lane[0] = plane[n] > lane[0] ? plane[n] : lane[0];
	}
	float largest = 0;
	for (int m = 0; m < 16; m++)
		largest = lane[m] > largest ? lane[m] : largest;
	return largest;
}

static bp_status expanded_fill(struct table *t, const struct expansion *e, float largest, bp_error *error)
{
	t->row = (t->dims.phi_d + 1) * (uint32_t)t->channels;
	t->slice = t->row * t->dims.theta_d;
	t->store_bytes = (size_t)t->row * t->dims.theta_h * t->dims.theta_d * sizeof(uint16_t) + TABLE_SLACK_BYTES;
	t->store = memory_alloc(t->store_bytes);
	if (!t->store)
		return error_memory(error, t->store_bytes);
	const float factor = table_factor(largest);
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
				to[k] = table_encode(red[k] * (factor / 3) + green[k] * (factor / 3) + blue[k] * (factor / 3));
		}
		memcpy(to + (size_t)t->channels * width, to, (size_t)t->channels * sizeof *to);
	}
	memset(to, 0, TABLE_SLACK_BYTES);
	return BP_OK;
}

bp_status table_build(const struct expansion *expansion, enum table_form form, int channels, struct table **out, bp_error *error)
{
	if (!lattice_dims_legal(expansion->dims) || (channels != 1 && channels != 3) || (form != TABLE_EXPANDED && form != TABLE_COMPACT))
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "no such form of table (form %d, %d channels)", (int)form, channels);
	struct table *t = calloc(1, sizeof *t);
	if (!t)
		return error_memory(error, sizeof *t);
	t->form = form;
	t->channels = channels;
	t->dims = expansion->dims;
	t->scale = lattice_scale_of(t->dims);
	t->top = (f32x4){(float)t->dims.theta_h - 1, (float)t->dims.theta_d - 1, (float)t->dims.phi_d, 0};
	t->inner = t->top - (f32x4){0.5f, 0.5f, 0.5f, 0};
	float largest = largest_value(expansion);
	double unit = largest * expansion->unit;
	t->unit = (float)(unit < TABLE_LARGEST ? unit : TABLE_LARGEST);
	bp_status status = (form == TABLE_COMPACT ? compact_fill : expanded_fill)(t, expansion, largest, error);
	if (status) {
		table_free(t);
		return status;
	}
	bool avx2 = kernels_avx2_usable();
	if (form == TABLE_COMPACT)
		t->kernels = (avx2 ? table_compact_avx2 : table_compact_plain)[channels == 3];
	else
		t->kernels = (avx2 ? table_expanded_avx2 : table_expanded_plain)[channels == 3];
	*out = t;
	return BP_OK;
}

void table_free(struct table *table)
{
	if (!table)
		return;
	free(table->store);
	free(table);
}

size_t table_bytes(const struct table *table)
{
	return sizeof *table + table->store_bytes;
}

struct lattice_dims table_dims(const struct table *table)
{
	return table->dims;
}

void table_evaluate(const struct table *table, const float wi[3], const float wo[3], float rgb[3])
{
	table->kernels.evaluate(table, wi, wo, rgb);
}

void table_nearest(const struct table *table, const float wi[3], const float wo[3], float rgb[3])
{
	table->kernels.nearest(table, wi, wo, rgb);
}

void table_evaluate_batch(const struct table *table, size_t count, const float *const wi[3], const float *const wo[3], float *const rgb[3])
{
	table->kernels.batch(table, count, wi, wo, rgb);
}
