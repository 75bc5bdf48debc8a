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

	bp_status status = lattice_dims_check(lattice->dims, error);
	if (status)
		return status;
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

bp_status model_expand(const struct model *model, uint32_t layers, struct expansion *out, bp_error *error)
{
	const struct lattice_dims a = model->dims, b = out->block ? out->dims : a;
	const bp_status status = out->block ? BP_OK : expansion_alloc(a, out, error);

	if (status)
		return status;
	if (!lattice_dims_equal(a, b))
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "the table has %u x %u x %u cells, the model %u x %u x %u",
		                 b.theta_h, b.theta_d, b.phi_d, a.theta_h, a.theta_d, a.phi_d);
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
