#include "spectral_terms.h"

#include <stdlib.h>

#include "error.h"

uint32_t spectral_lowest_plane(uint32_t planes, uint32_t harmonics, uint32_t end, uint32_t field, uint32_t harmonic)
{
	const uint32_t first = field * harmonics + harmonic,
				   period = 3 * harmonics; /* in the highest plane, and from plane to plane */
	return end > first ? planes - 1 - (end - 1 - first) / period : planes;
}

float spectral_level_value(const struct spectral_model *model, int32_t level, uint32_t lowest)
{
	const uint32_t magnitude = (uint32_t)(level < 0 ? -level : level) >> lowest << lowest;
	float value;

	if (!magnitude)
		return 0;
	if (lowest)
		value = (float)magnitude + model->centre[2] * (float)(1u << lowest);
	else
		value = (float)magnitude + model->centre[magnitude > 1];
	value *= model->step;
	return level < 0 ? -value : value;
}

static void terms_of_levels(const struct spectral_model *model, const struct spectrum_inverse *inverse, uint32_t layers,
                            struct spectral_terms *out)
{
	const uint32_t p = inverse->dims.phi_d, cells = (uint32_t)lattice_cells(inverse->dims);
	uint32_t n = 0, unit = 0, lowest = 0; /* units below this one have their start */

	for (uint32_t i = 0; i < model->level_count; i++) {
		const struct spectral_level level = model->levels[i];
		const uint32_t field = level.at < cells ? 0 : level.at < 2 * cells ? 1 : 2, at = level.at - field * cells;
		const uint32_t row = at / p, harmonic = spectrum_harmonic(p, at - row * p);
		if (unit <= field * p + harmonic) {
			while (unit <= field * p + harmonic)
				out->start[unit++] = n;
			lowest = spectral_lowest_plane(model->planes, p, model->end[layers - 1], field, harmonic);
		}
		const float value = spectral_level_value(model, level.level, lowest);
		if (value != 0)
			out->term[n++] = spectrum_term_make(inverse, row, value);
	}
	while (unit <= 3 * p)
		out->start[unit++] = n;
}

/* A fitted model has hardly a coefficient that is exactly 0: this is correct rather than quick. */
static void terms_of_coefficients(const struct spectral_model *model, const struct spectrum_inverse *inverse,
                                  struct spectral_terms *out)
{
	const struct lattice_dims d = inverse->dims;
	uint32_t n = 0;

	for (uint32_t unit = 0; unit < 3 * d.phi_d; unit++) {
		const float *lane = model->coefficient[unit / d.phi_d] + spectrum_lane(d.phi_d, unit % d.phi_d);
		out->start[unit] = n;
		for (uint32_t r = 0; r < d.theta_h * d.theta_d; r++)
			if (lane[(size_t)r * d.phi_d] != 0)
				out->term[n++] = spectrum_term_make(inverse, r, lane[(size_t)r * d.phi_d]);
	}
	out->start[3 * d.phi_d] = n;
}

bp_status spectral_terms_make(const struct spectral_model *model, const struct spectrum_inverse *inverse, uint32_t layers,
                              struct spectral_terms *out, bp_error *error)
{
	const size_t room = model->coefficient[0] ? 3 * lattice_cells(inverse->dims) : model->level_count;

	out->term = malloc((room ? room : 1) * sizeof *out->term);
	out->start = malloc((3 * (size_t)inverse->dims.phi_d + 1) * sizeof *out->start);
	if (!out->term || !out->start)
		return error_memory(error, room * sizeof *out->term);
	if (model->coefficient[0])
		terms_of_coefficients(model, inverse, out);
	else
		terms_of_levels(model, inverse, layers, out);
	return BP_OK;
}

void spectral_terms_free(struct spectral_terms *terms)
{
	free(terms->term);
	free(terms->start);
}
