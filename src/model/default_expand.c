/* default_expand.c: coefficients become a table; the inverse of default_fit.c. The table itself holds the spectra meanwhile. */
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "default_model.h"
#include "kernels.h"
#include "spectrum.h"

uint32_t default_lowest_plane(uint32_t planes, uint32_t harmonics, uint32_t end, uint32_t field, uint32_t harmonic)
{
	const uint32_t first = field * harmonics + harmonic, period = 3 * harmonics; /* in the highest plane, and from plane to plane */
	return end > first ? planes - 1 - (end - 1 - first) / period : planes;
}

float default_level_value(const struct default_model *model, struct lattice_dims d, uint32_t layers, const struct default_level *level,
                          struct default_place *place)
{
	const size_t cells = lattice_cells(d);
	const uint32_t even = (d.phi_d + 1) / 2, lane = (uint32_t)(level->at % cells) % d.phi_d;

	place->field = (uint32_t)(level->at / cells);
	place->row = (uint32_t)(level->at % cells) / d.phi_d;
	place->kind = lane >= even;
	place->order = place->kind ? lane - even : lane;
	const uint32_t harmonic = 2 * place->order + place->kind;
	const uint32_t lowest = default_lowest_plane(model->planes, d.phi_d, model->end[layers - 1], place->field, harmonic);
	const uint32_t magnitude = (uint32_t)(level->level < 0 ? -level->level : level->level) >> lowest << lowest;
	float value;

	if (!magnitude)
		return 0;
	if (lowest)
		value = (float)magnitude + model->centre[2] * (float)(1u << lowest);
	else
		value = (float)magnitude + model->centre[magnitude > 1];
	value *= model->step;
	return level->level < 0 ? -value : value;
}

/* Puts the levels, as far as the layers hold them, into the zeroed spectra; notes how many lanes of either kind are in use. */
static void levels_place(const struct default_model *model, struct lattice_dims d, uint32_t layers, float *const field[3], uint32_t used[2])
{
	const size_t cells = lattice_cells(d);

	for (uint32_t i = 0; i < model->level_count; i++) {
		struct default_place place;
		const float value = default_level_value(model, d, layers, &model->levels[i], &place);
		if (value == 0)
			continue;
		field[place.field][model->levels[i].at % cells] = value;
		used[place.kind] = place.order + 1 > used[place.kind] ? place.order + 1 : used[place.kind];
	}
}

bp_status default_expand(const struct model *model, uint32_t layers, struct expansion *out, bp_error *error)
{
	const struct kernels *kernels = kernels_get();
	const struct default_model *m = model->log_density;
	const struct lattice_dims d = model->dims;
	const size_t cells = lattice_cells(d), slice = (size_t)d.theta_d * d.phi_d;
	uint32_t used[2] = {0, 0};
	struct spectrum *spectrum = NULL;
	float *fields = malloc(3 * slice * sizeof *fields);
	bp_status status = fields ? spectrum_create(d, &spectrum, error) : error_memory(error, 3 * slice * sizeof *fields);

	if (status)
		goto out;
	for (int f = 0; f < 3; f++)
		if (m->coefficient[f])
			memcpy(out->rgb[f], m->coefficient[f], cells * sizeof(float));
		else
			memset(out->rgb[f], 0, cells * sizeof(float));
	if (m->coefficient[0]) {
		used[0] = (d.phi_d + 1) / 2;
		used[1] = d.phi_d / 2;
	} else {
		levels_place(m, d, layers, out->rgb, used);
	}
	for (int f = 0; f < 3; f++)
		spectrum_inverse_wavelets(spectrum, out->rgb[f], used[0], used[1]);
	for (size_t i = 0; i < d.theta_h; i++) {
		const float *const field[3] = {fields, fields + slice, fields + 2 * slice};
		float *const rgb[3] = {out->rgb[0] + i * slice, out->rgb[1] + i * slice, out->rgb[2] + i * slice};
		for (int f = 0; f < 3; f++)
			spectrum_inverse_slice(spectrum, rgb[f], used[0], used[1], fields + (size_t)f * slice);
		kernels->default_values(field, slice, m->base, (const float(*)[3])m->rotation, DEFAULT_OFFSET, rgb);
	}
	out->unit = m->unit;
out:
	spectrum_free(spectrum);
	free(fields);
	return status;
}
