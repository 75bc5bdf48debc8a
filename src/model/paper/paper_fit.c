/*
 * paper_fit.c: a measured lattice becomes the paper's model.
 *
 *     0  density                 marginal.h
 *     1  marginals               marginal.h
 *     2  c_hd, c_hphi            copula.h, field.h: Haar, 1/16 of the cells
 *     3  c_dphi|h per slice      Daubechies, 1/64
 *     4  one slice for all from 40 degrees on
 *     5  colours                 robust.h, on the decoded model
 */
#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "stage.h"
#include "copula.h"
#include "field.h"
#include "model/math/fill.h"
#include "paper.h"
#include "model/robust/robust.h"

/* A pair within this rms of 1 is left out: a tenth of the 1 % that measurements reproduce to. */
static const double TOLERANCE = 1e-3;
enum { KEEP_PAIR = 16, KEEP_SLICE = 64 };

/* One marginal with mean 1; indices without a valid cell get what their neighbours suggest. Returns the mean that was divided out. */
static bp_status marginal_fit(const struct means *means, uint32_t n, bool periodic, float **out, double *mean, bp_error *error)
{
	struct fill *fill = NULL;
	float *f = malloc(n * sizeof *f);
	double sum = 0, largest = 0;

	if (!f)
		return error_memory(error, n * sizeof *f);
	*out = f;
	bp_status status = fill_create(1, n, false, periodic, &fill, error);
	if (status)
		return status;
	for (uint32_t i = 0; i < n; i++)
		largest = fmax(largest, means->value[i]);
	for (uint32_t i = 0; i < n; i++)
		f[i] = largest > 0 ? (float)(means->value[i] / largest) : 1;
	fill_plane(fill, f, means->valid, 1);
	fill_free(fill);
	for (uint32_t i = 0; i < n; i++)
		sum += (double)f[i];
	*mean = largest > 0 ? largest * (sum / n) : 1;
	for (uint32_t i = 0; i < n; i++)
		f[i] = (float)((double)f[i] / (sum / n));
	return BP_OK;
}

static bp_status pairs_fit(const struct density *density, struct paper_model *paper, double *value, uint8_t *defined, bp_error *error)
{
	const struct lattice_dims d = density->dims;
	struct field_codec *hd = NULL, *hphi = NULL;
	bp_status status = field_codec_create(WAVELET_HAAR, d.theta_h, d.theta_d, &hd, error);

	if (status)
		goto out;
	copula_hd(density, value, defined);
	status = field_fit(hd, value, defined, d.theta_h * d.theta_d / KEEP_PAIR, TOLERANCE, &paper->hd, error);
	if (status)
		goto out;
	status = field_codec_create(WAVELET_HAAR, d.theta_h, d.phi_d, &hphi, error);
	if (status)
		goto out;
	copula_hphi(density, value, defined);
	status = field_fit(hphi, value, defined, d.theta_h * d.phi_d / KEEP_PAIR, TOLERANCE, &paper->hphi, error);
out:
	field_codec_free(hd);
	field_codec_free(hphi);
	return status;
}

static bp_status slices_fit(const struct density *density, struct paper_model *paper, double *value, uint8_t *defined, bp_error *error)
{
	const struct lattice_dims d = density->dims;
	const uint32_t shared = paper_shared_from(d.theta_h);
	struct field_codec *codec = NULL;
	bp_status status = field_codec_create(WAVELET_DAUBECHIES, d.theta_d, d.phi_d, &codec, error);

	if (status)
		return status;
	paper->slice = calloc(shared + 1, sizeof *paper->slice);
	if (!paper->slice)
		status = error_memory(error, (shared + 1) * sizeof *paper->slice);
	else
		paper->slice_count = shared + 1;
	for (uint32_t i = 0; !status && i <= shared; i++) {
		if (i < shared)
			copula_slice(density, i, value, defined);
		else
			copula_shared(density, i, value, defined);
		status = field_fit(codec, value, defined, d.theta_d * d.phi_d / KEEP_SLICE, TOLERANCE, &paper->slice[i], error);
	}
	field_codec_free(codec);
	return status;
}

bp_status paper_fit(const struct lattice *lattice, const struct watch *watch, struct paper_model **out, struct colour_fit colour[3], bp_error *error)
{
	const struct lattice_dims d = lattice->dims;
	const size_t largest_field = (size_t)(d.theta_h > d.theta_d ? d.theta_h : d.theta_d) * (d.theta_d > d.phi_d ? d.theta_d : d.phi_d);
	struct paper_model *paper = calloc(1, sizeof *paper);
	struct density density = {.value = NULL};
	double *value = NULL;
	uint8_t *defined = NULL;
	float *achromatic = NULL;
	double means[3];

	if (!paper)
		return error_memory(error, sizeof *paper);
	paper->dims = d;
	stage_enter(STAGE_CLEAN);
	bp_status status = density_build(lattice, &density, error);
	if (status)
		goto out;
	value = malloc(largest_field * sizeof *value);
	defined = malloc(largest_field);
	achromatic = malloc(lattice_cells(d) * sizeof *achromatic);
	if (!value || !defined || !achromatic) {
		status = error_memory(error, lattice_cells(d) * sizeof *achromatic);
		goto out;
	}
	stage_enter(STAGE_TRANSFORM);
	status = watch_tell(watch, 0.1, error);
	status = status ? status : marginal_fit(&density.axis[0], d.theta_h, false, &paper->marginal[0], &means[0], error);
	status = status ? status : marginal_fit(&density.axis[1], d.theta_d, false, &paper->marginal[1], &means[1], error);
	status = status ? status : marginal_fit(&density.axis[2], d.phi_d, true, &paper->marginal[2], &means[2], error);
	if (status)
		goto out;
	/* The copulas are ratios of means, the marginals have mean 1: their means go into the scale. */
	paper->scale = density.mean * means[0] * means[1] * means[2];
	status = pairs_fit(&density, paper, value, defined, error);
	status = status ? status : watch_tell(watch, 0.3, error);
	status = status ? status : slices_fit(&density, paper, value, defined, error);
	status = status ? status : watch_tell(watch, 0.5, error);
	if (status)
		goto out;
	density_free(&density);
	status = paper_achromatic(paper, PAPER_LAYERS, achromatic, error);
	stage_enter(STAGE_REGRESSION);
	status = status ? status : robust_fit_colour(lattice, achromatic, paper->scale, colour, error);
out:
	density_free(&density);
	free(value);
	free(defined);
	free(achromatic);
	if (status)
		paper_free(paper);
	else
		*out = paper;
	return status;
}
