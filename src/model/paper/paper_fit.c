/*
 * paper_fit.c: a measured lattice becomes the paper's model, channel by channel.
 *
 *     0  density                      importance.h: values in a unit, and what an error in each of them does to a picture
 *     1  marginals                    marginal.h
 *     2  c_hd, c_hphi, shared slice   pairs.h: Haar, 1/16 of the cells; one slice for all from 40 degrees on
 *     3  c_dphi|h per slice           slices.h: Daubechies, 1/64
 *     4  colour                       robust.h, on the decoded model, unless that loses it
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "slices.h"
#include "stage.h"
#include "watch.h"

static const double LINE_WORSE = 1.25;

/* What the channels share. */
struct workshop {
	struct lattice_dims dims;
	struct importance *importance;
	double unit; /* of value, 1/sr */
	struct sparse_fit pairs[2], slices;
	float *value, *weight, *shown; /* [cells]; value, which owns all, becomes the decoded model */
	float *fields;                 /* of a channel_fit */
};

static void workshop_free(struct workshop *w)
{
	free(w->importance);
	sparse_fit_free(&w->pairs[0]);
	sparse_fit_free(&w->pairs[1]);
	sparse_fit_free(&w->slices);
	free(w->value);
}

static bp_status workshop_open(const struct lattice *lattice, struct workshop *w, bp_error *error)
{
	const struct lattice_dims d = lattice->dims;
	const size_t cells = lattice_cells(d);
	const size_t fields = (size_t)d.theta_h * (d.theta_d + d.phi_d) + 2 * (size_t)d.theta_d * d.phi_d;
	struct wavelet_plane plane[3];

	memset(w, 0, sizeof *w);
	w->dims = d;
	for (int kind = 0; kind < 3; kind++)
		plane[kind] = paper_plane(d, (enum paper_field)kind);
	bp_status status = importance_create(d, &w->importance, error);
	status = status ? status : sparse_fit_create(&plane[PAPER_HD], &w->pairs[0], error);
	status = status ? status : sparse_fit_create(&plane[PAPER_HPHI], &w->pairs[1], error);
	status = status ? status : sparse_fit_create(&plane[PAPER_SLICE], &w->slices, error);
	if (status)
		return status;
	w->value = malloc((3 * cells + fields) * sizeof *w->value);
	if (!w->value)
		return error_memory(error, (3 * cells + fields) * sizeof(float));
	w->weight = w->value + cells;
	w->shown = w->weight + cells;
	w->fields = w->shown + cells;
	w->unit = importance_unit(w->importance, lattice);
	importance_shown(w->importance, lattice, w->shown);
	return BP_OK;
}

/* All but the colour. */
static bp_status channel_fit(struct workshop *w, const struct lattice *lattice, int c, struct paper_channel *out, bp_error *error)
{
	const struct lattice_dims d = w->dims;
	struct channel_fit fit = {.dims = d, .value = w->value, .weight = w->weight, .hd = w->fields};

	stage_enter(STAGE_CLEAN);
	importance_weigh(w->importance, lattice, c, w->unit, w->value, w->weight);
	fit.hphi = fit.hd + (size_t)d.theta_h * d.theta_d;
	fit.shared = fit.hphi + (size_t)d.theta_h * d.phi_d;
	fit.shared_weight = fit.shared + (size_t)d.theta_d * d.phi_d;
	bp_status status = marginals_alloc(d, &fit.marginal, error);
	stage_enter(STAGE_TRANSFORM);
	status = status ? status : marginals_fit(d, w->value, w->shown, &fit.marginal, error);
	status = status ? status : pairs_fit(&fit, w->pairs, &out->hd, &out->hphi, error);
	status = status ? status : paper_marginals_alloc(d, out, error);
	if (!status) {
		memcpy(out->marginal[0], fit.marginal.h, paper_marginal_values(d) * sizeof(float));
		out->slice_count = paper_shared_from(d.theta_h) + 1;
		out->scale = (double)fit.level * w->unit;
		out->slice = calloc(out->slice_count, sizeof *out->slice);
		status = out->slice ? slices_fit(&fit, &w->slices, out->slice, error)
		                    : error_memory(error, out->slice_count * sizeof *out->slice);
	}
	free(fit.marginal.h);
	return status;
}

/* What a picture shows of a channel's error under a line: the weighted sum of squares, in the unit. model: w->value. */
static double line_error(const struct workshop *w, const struct lattice *lattice, int c, double level, double diffuse,
                         double specular)
{
	double sum = 0;

	for (uint32_t row = 0; row < w->dims.theta_h * w->dims.theta_d; row++) {
		const size_t at = (size_t)row * w->dims.phi_d;
		double of_row = 0;
		for (size_t n = at; n < at + w->dims.phi_d; n++) {
			const double value = diffuse + specular * level * (double)w->value[n],
						 e = lattice->rgb[c][n] / w->unit - (value > 0 ? value : 0);
			of_row += lattice->valid[n] ? (double)w->weight[n] * e * e : 0;
		}
		sum += of_row;
	}
	return sum;
}

/*
 * The regression follows the many: where more than half of a channel is as good as black, its line is 0, lobe and all. Where it
 * loses that much against the model as it is, the model stays as it is.
 */
static void colour_settle(const struct workshop *w, const struct lattice *lattice, int c, const struct paper_channel *channel,
                          struct colour_fit *colour)
{
	const double level = channel->scale / w->unit;
	const double plain = line_error(w, lattice, c, level, 0, 1);
	const double line = line_error(w, lattice, c, level, colour->diffuse / w->unit, colour->specular);

	if (!(line <= LINE_WORSE * plain)) {
		colour->diffuse = 0;
		colour->specular = 1;
	}
}

bp_status paper_fit(const struct lattice *lattice, const struct watch *watch, struct paper_model **out,
                    struct colour_fit colour[3], bp_error *error)
{
	struct paper_model *paper = calloc(1, sizeof *paper);
	struct workshop w;

	if (!paper)
		return error_memory(error, sizeof *paper);
	paper->dims = lattice->dims;
	bp_status status = workshop_open(lattice, &w, error);
	for (int c = 0; !status && c < 3; c++) {
		status = watch_tell(watch, 0.05 + 0.3 * c, error);
		status = status ? status : channel_fit(&w, lattice, c, &paper->channel[c], error);
		stage_enter(STAGE_REGRESSION);
		status = status ? status : paper_channel_expand(paper->dims, &paper->channel[c], w.value, error);
		status = status ? status : robust_fit_channel(lattice, c, w.value, paper->channel[c].scale, &colour[c], error);
		if (!status)
			colour_settle(&w, lattice, c, &paper->channel[c], &colour[c]);
	}
	workshop_free(&w);
	if (status)
		paper_free(paper);
	else
		*out = paper;
	return status;
}
