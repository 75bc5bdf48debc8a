/*
 * spectral_fit.c: a measured lattice becomes the spectra of three fields.
 *
 *     logarithms -> fill -> spectrum, rows cut at the horizon, per channel -> rotation to the channels' principal axes -> noise
 *     drawn towards 0 -> weights
 *
 * and, beside it, the paper's colour regression on the measured achromatic table.
 *
 * The only thing with a scale is the unit, and it scales with the table: multiply every value by s, and the logarithms, and
 * all that is made of them, stay what they were.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "stage.h"
#include "spectral.h"
#include "spectral_survey.h"
#include "model/math/fast_math.h"
#include "spectral_kernels.h"
#include "spectrum.h"

void spectral_free(struct spectral_model *model)
{
	if (!model)
		return;
	free(model->coefficient[0]); /* the three are one block */
	free(model->levels);
	free(model);
}

static void turn(double *x, double *y, double cosine, double sine)
{
	const double from = *x;
	*x = cosine * from - sine * *y;
	*y = sine * from + cosine * *y;
}

/* Eigenvectors of a symmetric matrix by Jacobi rotations: columns of v. */
static void eigenvectors(double a[3][3], double v[3][3])
{
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++)
			v[i][j] = i == j;
	for (int sweep = 0; sweep < 12; sweep++)
		for (int p = 0; p < 2; p++)
			for (int q = p + 1; q < 3; q++) {
				if (a[p][q] == 0)
					continue;
				/* Golub and Van Loan, 8.5: tan, cos and sin without trigonometry. */
				const double tau = (a[q][q] - a[p][p]) / (2 * a[p][q]);
				const double t = (tau >= 0 ? 1 : -1) / (fabs(tau) + sqrt(1 + tau * tau)), c = 1 / sqrt(1 + t * t), s = t * c;
				for (int i = 0; i < 3; i++)
					turn(&a[i][p], &a[i][q], c, s);
				for (int i = 0; i < 3; i++) {
					turn(&a[p][i], &a[q][i], c, s);
					turn(&v[i][p], &v[i][q], c, s);
				}
			}
}

/*
 * Principal axes of the channels' coefficients, every coefficient with weight 1/(1 + its energy): what counts is the
 * direction of the many, not the size of the few. Every third row will do.
 */
static void rotation_find(float *const channel[3], size_t rows, size_t lanes, float rotation[3][3])
{
	const struct spectral_kernels *kernels = spectral_kernels_get();
	double moment[6] = {0}, v[3][3];
	int order[3] = {0, 1, 2};

	for (size_t r = 1; r < rows; r += 3) {
		const float *const x[3] = {channel[0] + r * lanes, channel[1] + r * lanes, channel[2] + r * lanes};
		kernels->spectral_moments(x, lanes, moment);
	}
	double a[3][3] = {{moment[0], moment[1], moment[2]}, {moment[1], moment[3], moment[4]}, {moment[2], moment[4], moment[5]}};
	eigenvectors(a, v);
	for (int i = 0; i < 3; i++)
		for (int j = i + 1; j < 3; j++)
			if (a[order[j]][order[j]] > a[order[i]][order[i]]) {
				int swap = order[i];
				order[i] = order[j];
				order[j] = swap;
			}
	for (int f = 0; f < 3; f++) {
		const double sum = v[0][order[f]] + v[1][order[f]] + v[2][order[f]];
		for (int c = 0; c < 3; c++)
			rotation[f][c] = (float)(sum < 0 ? -v[c][order[f]] : v[c][order[f]]);
	}
}

/*
 * The lattice, with only the cells that a picture can be made of as valid ones; *counted, which the caller frees, is their marks.
 * What lies wholly below the horizon is filled instead: it would cost as much as what is seen (VARIANTS.md), and interpolation
 * takes less than half of its value from it. Where nothing else is there, all valid cells stay.
 */
static bp_status seen_cells(const struct lattice *lattice, struct lattice *out, uint8_t **counted, bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims);
	size_t count = 0;

	*out = *lattice;
	*counted = malloc(cells);
	if (!*counted)
		return error_memory(error, cells);
	lattice_seen(lattice->dims, *counted);
	for (size_t n = 0; n < cells; n++)
		count += (*counted)[n] &= lattice->valid[n];
	if (count) {
		out->valid = *counted;
		out->valid_count = count;
	}
	return BP_OK;
}

/* Logarithms in the making: of the first `done` cells of every table, with their sums. */
struct logs {
	const struct lattice *lattice;
	const int *order;
	const struct spectral_model *fitted;
	double sum[3];
	size_t done[3];
};

static void logs_ready(void *user, int k, size_t end)
{
	enum { PIECE = 2048 }; /* sums are joined piece by piece, whatever is asked for */
	struct logs *logs = user;
	const struct lattice *lattice = logs->lattice;
	const size_t cells = lattice_cells(lattice->dims);

	for (size_t at; (at = logs->done[k]) < end;) {
		const size_t count = cells - at < PIECE ? cells - at : PIECE;
		logs->sum[k] += spectral_kernels_get()->spectral_logs(lattice->rgb[logs->order[k]] + at, lattice->valid + at, count,
		                                                      1 / logs->fitted->unit, logs->fitted->coefficient[k] + at);
		logs->done[k] += count;
	}
}

/* The channels' logarithms, channel order[k] in coefficient[k], with values for the invalid cells; and the base. */
static bp_status logs_make(const struct lattice *lattice, const int order[3], struct spectral_model *fitted, bp_error *error)
{
	struct logs logs = {.lattice = lattice, .order = order, .fitted = fitted};

	stage_enter(STAGE_CLEAN);
	const bp_status status = spectral_fill(lattice->dims, lattice->valid, fitted->coefficient, logs_ready, &logs, error);
	for (int k = 0; k < 3 && !status; k++)
		fitted->base[order[k]] = (float)(logs.sum[k] / (double)lattice->valid_count);
	return status;
}

/* Tables of logarithms become spectra, still of channels; rotation: their axes, of the channels in that order. */
static void spectra_make(struct lattice_dims d, struct spectrum *spectrum, const int order[3], struct spectral_model *fitted,
                         float rotation[3][3])
{
	stage_enter(STAGE_TRANSFORM);
	for (int k = 0; k < 3; k++)
		spectrum_forward(spectrum, fitted->coefficient[k], fitted->base[order[k]]);
	rotation_find(fitted->coefficient, (size_t)d.theta_h * d.theta_d, d.phi_d, rotation);
}

/* Spectra of channels become those of fields. */
static bp_status fields_make(struct lattice_dims d, struct spectrum *spectrum, const int order[3], const float rotation[3][3],
                             bool denoise, const struct watch *watch, struct spectral_model *fitted, bp_error *error)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d;
	bp_status status = BP_OK;

	for (size_t r = 0; r < rows; r++) {
		float *const x[3] = {fitted->coefficient[0] + r * d.phi_d, fitted->coefficient[1] + r * d.phi_d,
		                     fitted->coefficient[2] + r * d.phi_d};
		spectral_kernels_get()->spectral_rotate(x, d.phi_d, rotation);
	}
	for (int f = 0; f < 3; f++)
		for (int k = 0; k < 3; k++)
			fitted->rotation[f][order[k]] = rotation[f][k];
	stage_enter(STAGE_CLEAN);
	if (denoise)
		status = spectral_denoise(spectrum, d, watch, fitted->coefficient, &fitted->noise, error);
	return status;
}

/* Steps of spectral_project by effort 0..9 (0: a record does not say): the first saves 3 % of a record, for a sixth of a fit. */
static const int PROJECTIONS[10] = {0, 0, 0, 0, 0, 0, 1, 2, 4, 8};

/* fields_make after better values have been found for the invalid cells; noise would only be carried on into them. */
static bp_status fields_improve(const struct lattice *lattice, const struct fit_options *options, struct spectrum *spectrum,
                                const int order[3], const float *filled, struct spectral_model *fitted, bp_error *error)
{
	const float base[3] = {fitted->base[order[0]], fitted->base[order[1]], fitted->base[order[2]]};
	float rotation[3][3];

	memcpy(fitted->coefficient[0], filled, 3 * lattice_cells(lattice->dims) * sizeof *filled);
	stage_enter(STAGE_CLEAN);
	bp_status status = watch_tell(options->watch, 0.5, error);
	if (status)
		return status;
	status = spectral_project(spectrum, lattice->dims, lattice->valid, base, &fitted->weights, fitted->limit,
	                          options->budget_bytes, PROJECTIONS[options->effort], fitted->coefficient, error);
	if (status)
		return status;
	spectra_make(lattice->dims, spectrum, order, fitted, rotation);
	return fields_make(lattice->dims, spectrum, order, (const float(*)[3])rotation, true, options->watch, fitted, error);
}

static const float SMALLEST_LEVEL = 0.8f; /* in steps, in the mean, of what is not coded as 0 */

/* By how much the step that a record of this size would have without weights is coarser than the noise. */
static float even_step_octaves(const struct spectral_model *fitted, double budget_bytes)
{
	const size_t rows = 3 * (size_t)fitted->dims.theta_h * fitted->dims.theta_d; /* the fields' tables lie one behind the other */
	const float least = spectral_size_of_rank(fitted->coefficient[0], rows, fitted->dims.phi_d, 3, spectral_places(budget_bytes));
	return fast_log2f(least / (SMALLEST_LEVEL * fitted->noise));
}

/* The last step: coefficients as they are quantised. */
static bp_status weights_divide(struct spectral_model *fitted, bp_error *error)
{
	struct spectral_factors factors;
	const bp_status status = spectral_factors_create(fitted->dims, &fitted->weights, &factors, error);

	if (status)
		return status;
	stage_enter(STAGE_CLEAN);
	for (int f = 0; f < 3; f++)
		spectral_factors_divide(fitted->dims, &factors, fitted->coefficient[f]);
	free(factors.row);
	return BP_OK;
}

bp_status spectral_fit(const struct lattice *lattice, const struct fit_options *options, struct spectral_model **out,
                       struct colour_fit colour[3], bp_error *error)
{
	const struct lattice_dims d = lattice->dims;
	const size_t cells = lattice_cells(d);
	/* An error bound is a promise about all measured values, their noise included. */
	const bool bound = options->max_error > 0, denoise = !bound;
	bool project = denoise && PROJECTIONS[options->effort] > 0;
	struct spectral_model *fitted = calloc(1, sizeof *fitted);
	struct spectrum *spectrum = NULL;
	struct spectral_survey sample = {0};
	struct lattice seen = *lattice;
	uint8_t *counted = NULL;
	float *filled = NULL, rotation[3][3];
	int order[3]; /* coefficient[k] is channel order[k], until it becomes field k */

	if (!fitted)
		return error_memory(error, sizeof *fitted);
	fitted->dims = d;
	stage_enter(STAGE_CLEAN);
	fitted->coefficient[0] = malloc(3 * cells * sizeof(float));
	if (!fitted->coefficient[0]) {
		free(fitted);
		return error_memory(error, 3 * cells * sizeof(float));
	}
	memory_prefer_huge(fitted->coefficient[0], 3 * cells * sizeof(float));
	fitted->coefficient[1] = fitted->coefficient[0] + cells;
	fitted->coefficient[2] = fitted->coefficient[1] + cells;
	stage_enter(STAGE_REGRESSION);
	bp_status status = spectral_survey_draw(lattice, &sample, error);
	if (!status)
		status = spectral_survey_colour(&sample, colour, error);
	stage_enter(STAGE_CLEAN);
	if (!status) {
		spectral_survey_order(&sample, order);
		fitted->unit = spectral_survey_unit(&sample, lattice);
	}
	free(sample.x);
	if (!status)
		status = watch_tell(options->watch, 0.1, error);
	if (!status && !bound) {
		status = seen_cells(lattice, &seen, &counted, error);
		const bool cut = !status && seen.valid == counted;
		project = project && cut;
		if (cut) {
			spectral_weights_find(&seen, fitted->unit, &fitted->weights);
			/* A model that is not graded has the limit of the horizon: records of such have no place for another. */
			fitted->limit = fitted->weights.graded ? spans_limit(&seen) : SPAN_MARGIN;
		}
	}
	if (!status)
		status = spectrum_create(d, fitted->limit, &spectrum, error);
	if (!status)
		status = logs_make(&seen, order, fitted, error);
	if (!status && project) {
		filled = malloc(3 * cells * sizeof *filled);
		if (filled)
			memcpy(filled, fitted->coefficient[0], 3 * cells * sizeof *filled);
		else
			status = error_memory(error, 3 * cells * sizeof *filled);
	}
	if (!status)
		status = watch_tell(options->watch, 0.2, error);
	if (!status)
		spectra_make(d, spectrum, order, fitted, rotation);
	if (!status)
		status = fields_make(d, spectrum, order, (const float(*)[3])rotation, denoise, options->watch, fitted, error);
	if (!status && project && !(fitted->noise > 0) && seen.valid_count < cells)
		status = fields_improve(&seen, options, spectrum, order, filled, fitted, error);
	if (!status && fitted->noise > 0)
		spectral_weights_ease(&fitted->weights, even_step_octaves(fitted, options->budget_bytes));
	if (!status && !bound)
		status = weights_divide(fitted, error);
	free(counted);
	free(filled);
	spectrum_free(spectrum);
	if (status)
		spectral_free(fitted);
	else
		*out = fitted;
	return status;
}
