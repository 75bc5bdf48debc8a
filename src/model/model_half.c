/* model_half.c: every second value of a model's table, by the quick way where the profile has one. */
#include "error.h"
#include "model/spectral/spectral.h"
#include "model.h"

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

	if (!model_has_half(model->dims, &half) || (out->block && !lattice_dims_equal(half, out->dims)))
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "%u x %u x %u cells are not half of %u x %u x %u",
		                 out->dims.theta_h, out->dims.theta_d, out->dims.phi_d, model->dims.theta_h, model->dims.theta_d,
		                 model->dims.phi_d);
	bp_status status = out->block ? BP_OK : expansion_alloc(half, out, error);
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
