/* model.c: from the profile's number to the profile's functions. */
#include "model.h"

#include <stdlib.h>

#include "error.h"
#include "stage.h"
#include "model/spectral/spectral.h"
#include "model/paper/paper.h"

bp_status model_fit(const struct lattice *lattice, const struct fit_options *options, struct model **out, bp_error *error)
{
	struct model *model;
	bp_status status;

	if (!lattice->valid_count)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "no valid cell: every value is negative, NaN or infinite");
	model = calloc(1, sizeof *model);
	if (!model)
		return error_memory(error, sizeof *model);
	model->profile = options->profile;
	model->dims = lattice->dims;
	model->horizon_limit = lattice_horizon_limit(lattice);
	switch (options->profile) {
	case PROFILE_PAPER:
		model->layer_count = PAPER_LAYERS;
		status = paper_fit(lattice, options->watch, &model->paper, model->colour, error);
		break;
	case PROFILE_SPECTRAL:
		model->layer_count = 1; /* the encoder cuts layers */
		status = spectral_fit(lattice, options, &model->spectral, model->colour, error);
		break;
	default: status = error_set(error, BP_ERROR_UNSUPPORTED, BP_NO_OFFSET, "profile %d is not known", (int)options->profile);
	}
	stage_enter(STAGE_REST);
	if (status)
		model_free(model);
	else
		*out = model;
	return status;
}

void model_free(struct model *model)
{
	if (!model)
		return;
	paper_free(model->paper);
	spectral_free(model->spectral);
	free(model);
}

/* A new table, or the one that is there where it has the extents. */
static bp_status expansion_ready(struct lattice_dims dims, struct expansion *out, bp_error *error)
{
	if (!out->block)
		return expansion_alloc(dims, out, error);
	if (lattice_dims_equal(dims, out->dims))
		return BP_OK;
	return error_argument(error, "the table has %u x %u x %u cells, the model %u x %u x %u", out->dims.theta_h, out->dims.theta_d,
	                      out->dims.phi_d, dims.theta_h, dims.theta_d, dims.phi_d);
}

bp_status model_expand(const struct model *model, uint32_t layers, struct expansion *out, bp_error *error)
{
	const bp_status status = expansion_ready(model->dims, out, error);

	if (status)
		return status;
	if (!layers || layers > model->layer_count)
		layers = model->layer_count;
	switch (model->profile) {
	case PROFILE_PAPER:
		/* A model of which all layers are wanted shows what it holds, whichever layers that came in. */
		return paper_expand(model->paper, model->colour, layers < model->layer_count ? layers : PAPER_LAYERS, out, error);
	case PROFILE_SPECTRAL: return spectral_expand(model->spectral, layers, false, out, error);
	default: return error_set(error, BP_ERROR_UNSUPPORTED, BP_NO_OFFSET, "profile %d is not known", (int)model->profile);
	}
}

/* ---- every second value, by the quick way where the profile has one ---- */

bool model_has_half(struct lattice_dims dims, struct lattice_dims *half)
{
	*half = (struct lattice_dims){dims.theta_h / 2, dims.theta_d / 2, dims.phi_d / 2};
	return dims.theta_h % 2 == 0 && dims.theta_d % 2 == 0 && dims.phi_d % 2 == 0 && lattice_dims_legal(*half);
}

static void half_take(const struct expansion *whole, struct expansion *out)
{
	const struct lattice_dims d = out->dims;
	for (int c = 0; c < 3; c++)
		for (uint32_t i = 0; i < d.theta_h; i++)
			for (uint32_t j = 0; j < d.theta_d; j++)
				for (uint32_t k = 0; k < d.phi_d; k++)
					out->rgb[c][lattice_index(d, i, j, k)] = whole->rgb[c][lattice_index(whole->dims, 2 * i, 2 * j, 2 * k)];
	out->unit = whole->unit;
}

bp_status model_expand_half(const struct model *model, struct expansion *out, bp_error *error)
{
	struct lattice_dims half;
	struct expansion whole = {0};

	if (!model_has_half(model->dims, &half))
		return error_argument(error, "%u x %u x %u cells have no halves", model->dims.theta_h, model->dims.theta_d,
		                      model->dims.phi_d);
	bp_status status = expansion_ready(half, out, error);
	if (status)
		return status;
	if (model->profile == PROFILE_SPECTRAL)
		return spectral_expand(model->spectral, model->layer_count, true, out, error);
	status = model_expand(model, 0, &whole, error);
	if (!status)
		half_take(&whole, out);
	expansion_free(&whole);
	return status;
}
