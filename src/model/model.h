/*
 * model.h: one fitted material in memory, whatever its profile.
 *
 *     lattice -> model_fit -> record_encode        record_decode -> model_expand -> table
 *
 * A model holds exactly what a record stores (quantised values), so encoding it and decoding it
 * again gives an equal model; all loss happens in model_fit.
 */
#ifndef MODEL_MODEL_H
#define MODEL_MODEL_H

#include "merl/lattice.h"
#include "fit.h"
#include "model/robust/robust.h"

struct paper_model;    /* paper.h */
struct spectral_model; /* spectral.h */

struct model {
	enum profile profile;
	struct lattice_dims dims;
	double horizon_limit; /* lattice_horizon_limit of the source */
	struct colour_fit colour[3];
	uint32_t layer_count;            /* 1..LAYERS_MAX; a decoded model has as many as were loaded */
	struct paper_model *paper;       /* PROFILE_PAPER, else NULL */
	struct spectral_model *spectral; /* PROFILE_SPECTRAL, else NULL */
};

bp_status model_fit(const struct lattice *lattice, const struct fit_options *options, struct model **out, bp_error *error);
void model_free(struct model *model); /* NULL is allowed */

/*
 * Expands layers 0..layers-1 (0: all that are there) over the whole lattice. *out is zeroed and allocated here, or has the
 * model's dims and is used again; the caller frees it in either case, also after a failure. BP_ERROR_ARGUMENT for a model of the
 * spectral profile that was fitted: only a decoded one has values.
 */
bp_status model_expand(const struct model *model, uint32_t layers, struct expansion *out, bp_error *error);

/*
 * Every second value along each axis, for a preview: value i of H/2 is value 2 i of H, and stands where that stands, at 2 i + 1/2
 * of H cells, which is i + 1/4 of H/2. All layers. The model's extents must be even and at least 8: BP_ERROR_ARGUMENT otherwise.
 * *out as above, of half the extents.
 */
bp_status model_expand_half(const struct model *model, struct expansion *out, bp_error *error);
bool model_has_half(struct lattice_dims dims, struct lattice_dims *half); /* sets *half where there is one */

#endif
