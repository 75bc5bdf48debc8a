/*
 * default_fit.c: a measured lattice becomes the spectra of three fields.
 *
 *     logarithms -> fill -> spectrum, per channel -> rotation to the channels' principal axes -> noise drawn towards 0
 *
 * and, beside it, the paper's colour regression on the measured achromatic table.
 *
 * The only thing with a scale is the unit, and it scales with the table: multiply every value by s, and the logarithms, and
 * all that is made of them, stay what they were.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "../memory.h"
#include "../stage.h"
#include "default_model.h"
#include "default_origin.h"
#include "default_sample.h"
#include "fast_math.h"
#include "kernels.h"
#include "spectrum.h"

void default_free(struct default_model *model)
{
	if (!model)
		return;
	free(model->coefficient[0]); /* the three are one block */
	free(model->levels);
	free(model);
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
				for (int i = 0; i < 3; i++) {
					const double x = a[i][p], y = a[i][q];
					a[i][p] = c * x - s * y;
					a[i][q] = s * x + c * y;
				}
				for (int i = 0; i < 3; i++) {
					const double x = a[p][i], y = a[q][i];
					a[p][i] = c * x - s * y;
					a[q][i] = s * x + c * y;
				}
				for (int i = 0; i < 3; i++) {
					const double x = v[i][p], y = v[i][q];
					v[i][p] = c * x - s * y;
					v[i][q] = s * x + c * y;
				}
			}
}

/*
 * Principal axes of the channels' coefficients, every coefficient with weight 1/(1 + its energy): what counts is the
 * direction of the many, not the size of the few. Every third row will do.
 */
static void rotation_find(float *const channel[3], size_t rows, size_t lanes, float rotation[3][3])
{
	const struct kernels *kernels = kernels_get();
	double moment[6] = {0}, v[3][3];
	int order[3] = {0, 1, 2};

	for (size_t r = 1; r < rows; r += 3) {
		const float *const x[3] = {channel[0] + r * lanes, channel[1] + r * lanes, channel[2] + r * lanes};
		kernels->default_moments(x, lanes, moment);
	}
	double a[3][3] = {
		{moment[0], moment[1], moment[2]}, {moment[1], moment[3], moment[4]}, {moment[2], moment[4], moment[5]}
	};
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

/* The channels' logarithms, channel order[k] in coefficient[k], with values for the invalid cells; and the base. */
static bp_status logs_make(const struct lattice *lattice, const int order[3], struct default_model *fitted, bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims);

	stage_enter(STAGE_CLEAN);
	for (int k = 0; k < 3; k++) {
		const double sum = kernels_get()->default_logs(lattice->rgb[order[k]], lattice->valid, cells, 1 / fitted->unit, fitted->coefficient[k]);
		fitted->base[order[k]] = (float)(sum / (double)lattice->valid_count);
	}
	return default_fill(lattice->dims, lattice->valid, fitted->coefficient, error);
}

/* Tables of logarithms become spectra, still of channels; rotation: their axes, of the channels in that order. */
static void spectra_make(struct lattice_dims d, struct spectrum *spectrum, const int order[3], struct default_model *fitted, float rotation[3][3])
{
	stage_enter(STAGE_TRANSFORM);
	for (int k = 0; k < 3; k++)
		spectrum_forward(spectrum, fitted->coefficient[k], fitted->base[order[k]]);
	rotation_find(fitted->coefficient, (size_t)d.theta_h * d.theta_d, d.phi_d, rotation);
}

/* Spectra of channels become those of fields. */
static bp_status fields_make(struct lattice_dims d, const int order[3], const float rotation[3][3], bool denoise, struct default_model *fitted,
                             bp_error *error)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d;
	bp_status status = BP_OK;

	for (size_t r = 0; r < rows; r++) {
		float *const x[3] = {fitted->coefficient[0] + r * d.phi_d, fitted->coefficient[1] + r * d.phi_d, fitted->coefficient[2] + r * d.phi_d};
		kernels_get()->default_rotate(x, d.phi_d, rotation);
	}
	for (int f = 0; f < 3; f++)
		for (int k = 0; k < 3; k++)
			fitted->rotation[f][order[k]] = rotation[f][k];
	stage_enter(STAGE_CLEAN);
	for (int f = 0; !status && f < 3 && denoise; f++)
		status = default_denoise(d, fitted->coefficient[f], &fitted->noisy, error);
	return status;
}

enum { UNIT_TURNS = 12 };
static const double UNIT_NEAR = 1e-6;                           /* of its log2: nothing is left to mend */
static const double MISSED_LITTLE = 0.0005, MISSED_MOST = 0.02; /* default_grid_missed: no unit is better; with the best unit, good enough */

/* A search for the unit: its log2, and by how much the grid told that it was too large; those of the turn before. */
struct unit_search {
	double reach; /* how far off it may be */
	double before, wrong;
};

/* The unit becomes what the grid tells of it. */
static bp_status unit_mend(const struct lattice *lattice, struct spectrum *spectrum, const int order[3], const struct default_origin *origin,
                           struct unit_search *search, struct default_model *fitted, bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims);
	const struct grid_evidence evidence = {lattice->dims, fitted->coefficient, origin->exact};
	float *block = memory_alloc(3 * cells * sizeof *block);

	if (!block)
		return error_memory(error, 3 * cells * sizeof *block);
	float *const slope[3] = {block, block + cells, block + 2 * cells};
	for (int k = 0; k < 3; k++) {
		const double *b = lattice->rgb[order[k]];
		for (size_t i = 0; i < cells; i++) /* of log2(1 + b / unit) by log2(unit) */
			slope[k][i] = lattice->valid[i] ? (float)(-b[i] / (fitted->unit + b[i])) : 0;
		spectrum_forward(spectrum, slope[k], 0);
	}
	const double wrong = default_grid_unit_error(&evidence, &origin->grid, slope, search->reach), now = fast_log2(fitted->unit);
	free(block);
	/* What is far off is taken for what is near another level, so too little is told: the secant says how much too little. */
	const double secant = search->wrong != wrong ? (now - search->before) / (wrong - search->wrong) : 1;
	const double factor = search->wrong == 0 ? 1 : fmin(fmax(secant, 0.3), 2.5);
	*search = (struct unit_search){.reach = fmin(4 * fabs(wrong), search->reach), .before = now, .wrong = wrong};
	fitted->unit = fmin(fmax(fast_exp2(now - fmin(fmax(factor * wrong, -1), 1)), DEFAULT_UNIT_LEAST), DEFAULT_UNIT_MOST);
	return BP_OK;
}

/*
 * Looks whether the table was decoded from a record (default_origin.h). Its unit is near that record's where the same cells are there, but a
 * statistic all the same: where there is a grid, better ones are tried.
 */
static bp_status origin_seek(const struct lattice *lattice, struct spectrum *spectrum, const int order[3], float rotation[3][3],
                             struct default_model *fitted, struct default_origin *origin, bool *found, bp_error *error)
{
	const double unit = fitted->unit;
	struct unit_search search = {.reach = 1};
	bp_status status = BP_OK;

	for (int turn = 0; !status; turn++) {
		const float base[3] = {fitted->base[order[0]], fitted->base[order[1]], fitted->base[order[2]]};
		const bool last = turn == UNIT_TURNS || (turn > 0 && fabs(search.wrong) < UNIT_NEAR);
		status = default_origin_find(lattice, fitted->coefficient, base, (const float(*)[3])rotation, origin, error);
		*found = !status && origin->missed < (last ? MISSED_MOST : MISSED_LITTLE);
		if (status || *found || (turn == 0 && isinf(origin->missed)))
			return status;
		const bool end = last || isinf(origin->missed);
		if (end)
			fitted->unit = unit;
		else
			status = unit_mend(lattice, spectrum, order, origin, &search, fitted, error);
		if (!status)
			status = logs_make(lattice, order, fitted, error);
		if (!status)
			spectra_make(lattice->dims, spectrum, order, fitted, rotation);
		if (end)
			return status;
		default_origin_free(origin);
	}
	return status;
}

/*
 * Where the table was decoded, the model gets that record's levels, and the spectra that are at hand are made anew with its base; *rotation
 * becomes that record's.
 */
static bp_status origin_restore(const struct lattice *lattice, struct spectrum *spectrum, const int order[3], float rotation[3][3],
                                struct default_model *fitted, bp_error *error)
{
	struct default_origin origin;
	bool found;
	bp_status status = origin_seek(lattice, spectrum, order, rotation, fitted, &origin, &found, error);

	if (!status && found) {
		status = logs_make(lattice, order, fitted, error);
		if (!status)
			status = default_origin_restore(lattice, order, &origin, spectrum, fitted->coefficient, fitted, error);
		if (!status)
			status = logs_make(lattice, order, fitted, error);
		for (int k = 0; !status && k < 3; k++) {
			fitted->base[order[k]] = origin.base[k];
			spectrum_forward(spectrum, fitted->coefficient[k], fitted->base[order[k]]);
		}
		memcpy(rotation, origin.grid.axis, sizeof origin.grid.axis);
	}
	default_origin_free(&origin);
	return status;
}

/* Steps of default_project by effort 1..9: what the first saves, 3 % of a record, costs a sixth of a fit. */
static const int PROJECTIONS[9] = {0, 0, 0, 0, 0, 1, 2, 4, 8};

/* fields_make after better values have been found for the invalid cells; noise would only be carried on into them. */
static bp_status fields_improve(const struct lattice *lattice, const struct fit_options *options, struct spectrum *spectrum, const int order[3],
                                const float *filled, struct default_model *fitted, bp_error *error)
{
	const float base[3] = {fitted->base[order[0]], fitted->base[order[1]], fitted->base[order[2]]};
	float rotation[3][3];
	bp_status status;

	memcpy(fitted->coefficient[0], filled, 3 * lattice_cells(lattice->dims) * sizeof *filled);
	stage_enter(STAGE_CLEAN);
	status = default_project(spectrum, lattice->dims, lattice->valid, base, options->budget_bytes, PROJECTIONS[options->effort - 1],
	                         fitted->coefficient, error);
	if (status)
		return status;
	spectra_make(lattice->dims, spectrum, order, fitted, rotation);
	return fields_make(lattice->dims, order, (const float(*)[3])rotation, true, fitted, error);
}

bp_status default_fit(const struct lattice *lattice, const struct fit_options *options, struct model *model, bp_error *error)
{
	const struct lattice_dims d = lattice->dims;
	const size_t cells = lattice_cells(d);
	/* An error bound is a promise about the measured values, their noise included. */
	const bool denoise = !(options->max_error > 0), project = denoise && PROJECTIONS[options->effort - 1] > 0;
	struct default_model *fitted = model->log_density = calloc(1, sizeof *fitted);
	struct spectrum *spectrum = NULL;
	struct default_sample sample = {0};
	float *filled = NULL, rotation[3][3];
	int order[3]; /* coefficient[k] is channel order[k], until it becomes field k */
	bp_status status;

	if (!fitted)
		return error_memory(error, sizeof *fitted);
	model->layer_count = 1;
	stage_enter(STAGE_CLEAN);
	fitted->coefficient[0] = malloc(3 * cells * sizeof(float));
	if (!fitted->coefficient[0])
		return error_memory(error, 3 * cells * sizeof(float));
	fitted->coefficient[1] = fitted->coefficient[0] + cells;
	fitted->coefficient[2] = fitted->coefficient[1] + cells;
	stage_enter(STAGE_REGRESSION);
	status = default_sample_draw(lattice, &sample, error);
	if (!status)
		status = default_sample_colour(&sample, model->colour, error);
	stage_enter(STAGE_CLEAN);
	if (!status) {
		default_sample_order(&sample, order);
		fitted->unit = default_sample_unit(&sample, lattice);
		status = spectrum_create(d, &spectrum, error);
	}
	default_sample_free(&sample);
	if (!status)
		status = logs_make(lattice, order, fitted, error);
	if (!status && project) {
		filled = malloc(3 * cells * sizeof *filled);
		if (filled)
			memcpy(filled, fitted->coefficient[0], 3 * cells * sizeof *filled);
		else
			status = error_memory(error, 3 * cells * sizeof *filled);
	}
	if (!status)
		spectra_make(d, spectrum, order, fitted, rotation);
	if (!status && denoise)
		status = origin_restore(lattice, spectrum, order, rotation, fitted, error);
	if (!status)
		status = fields_make(d, order, (const float(*)[3])rotation, denoise, fitted, error);
	if (!status && project && !fitted->levels && !fitted->noisy && lattice->valid_count < cells)
		status = fields_improve(lattice, options, spectrum, order, filled, fitted, error);
	free(filled);
	spectrum_free(spectrum);
	return status;
}
