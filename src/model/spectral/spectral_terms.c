#include "spectral_terms.h"

#include <stdlib.h>

#include "error.h"

uint32_t spectral_lowest_plane(uint32_t planes, uint32_t harmonics, uint32_t end, uint32_t field, uint32_t harmonic)
{
	const uint32_t first = field * harmonics + harmonic,
				   period = 3 * harmonics; /* in the highest plane, and from plane to plane */
	return end > first ? planes - 1 - (end - 1 - first) / period : planes;
}

float spectral_level_value(const struct spectral_model *model, int32_t level, uint32_t lowest, uint32_t quantiser)
{
	const uint32_t magnitude = (uint32_t)(level < 0 ? -level : level) >> lowest << lowest;
	float value;

	if (!magnitude)
		return 0;
	if (lowest) /* of the second quantiser as often as of the first */
		value = (float)magnitude + model->centre[3] * (float)(1u << lowest) - (model->dependent ? 0.25f : 0);
	else
		value = (float)magnitude + model->centre[magnitude > 1 ? 2 : quantiser] - (quantiser ? 0.5f : 0);
	value *= model->step;
	return level < 0 ? -value : value;
}

bp_status spectral_terms_make(const struct spectral_model *model, const struct spectrum_inverse *inverse, uint32_t layers,
                              struct spectral_terms *out, bp_error *error)
{
	const uint32_t p = inverse->dims.phi_d, cells = (uint32_t)lattice_cells(inverse->dims);
	uint32_t n = 0, unit = 0; /* units below this one have their start */
	uint32_t lowest = 0, state = 0;

	out->term = malloc(((size_t)model->level_count + 1) * sizeof *out->term);
	out->start = malloc((3 * (size_t)p + 1) * sizeof *out->start);
	if (!out->term || !out->start)
		return error_memory(error, model->level_count * sizeof *out->term);
	for (uint32_t i = 0; i < model->level_count; i++) {
		const struct spectral_level level = model->levels[i];
		const uint32_t field = level.at < cells ? 0 : level.at < 2 * cells ? 1 : 2, at = level.at - field * cells;
		const uint32_t row = at / p, harmonic = spectrum_harmonic(p, at - row * p);
		if (unit <= field * p + harmonic) {
			while (unit <= field * p + harmonic)
				out->start[unit++] = n;
			lowest = spectral_lowest_plane(model->planes, p, model->end[layers - 1], field, harmonic);
			state = 0;
		}
		const float value = spectral_level_value(model, level.level, lowest, dependent_quantiser(state));
		if (model->dependent && !lowest)
			state = dependent_next(state, (uint32_t)level.level & 1);
		if (value != 0)
			out->term[n++] = spectrum_term_make(inverse, row, harmonic, value);
	}
	while (unit <= 3 * p)
		out->start[unit++] = n;
	return BP_OK;
}

void spectral_terms_free(struct spectral_terms *terms)
{
	free(terms->term);
	free(terms->start);
}
