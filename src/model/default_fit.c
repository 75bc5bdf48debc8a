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
#include "../stage.h"
#include "default_model.h"
#include "kernels.h"
#include "robust.h"
#include "select.h"
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

/*
 * Cells that stand for all: SAMPLE of them at least, where there are as many, spread evenly over all angles. Which ones depends
 * on validity alone.
 */
enum { SAMPLE = 1 << 16 };

struct sample {
	double *x;    /* the achromatic value; owns the block */
	double *y[3]; /* the channels, one behind the other, n each */
	size_t n;
};

static size_t common_divisor(size_t a, size_t b)
{
	while (b) {
		const size_t rest = a % b;
		a = b;
		b = rest;
	}
	return a;
}

static bp_status sample_draw(const struct lattice *lattice, struct sample *out, bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims), p = lattice->dims.phi_d;
	size_t every = lattice->valid_count / SAMPLE + 1, n = 0; /* one cell of so many; no common factor: another phi_d in every row */
	double *y[3];

	while (common_divisor(every, p) != 1)
		every++;
	const size_t room = cells / every + 1;
	out->x = malloc(room * 4 * sizeof *out->x);
	if (!out->x)
		return error_memory(error, room * 4 * sizeof *out->x);
	for (size_t c = 0; c < 3; c++)
		y[c] = out->x + (c + 1) * room;
	for (size_t i = 0; i < cells; i += every) {
		/* Within the stride, the first valid cell: where few are valid, none is passed over. */
		size_t at = i;
		const size_t last = i + every < cells ? i + every : cells;
		while (at < last && !lattice->valid[at])
			at++;
		if (at == last)
			continue;
		for (int c = 0; c < 3; c++)
			y[c][n] = lattice->rgb[c][at];
		out->x[n] = y[0][n] / 3 + y[1][n] / 3 + y[2][n] / 3;
		n++;
	}
	out->n = n;
	for (size_t c = 0; c < 3; c++) {
		out->y[c] = out->x + (c + 1) * n;
		memmove(out->y[c], y[c], n * sizeof *y[c]);
	}
	return BP_OK;
}

/*
 * The paper's regression of each channel on the measured achromatic value. The fields carry colour, so these six numbers are a summary
 * here: a sample gives them in a twentieth of the time. On the nine surrogates of manifests/paper-nine.txt the slopes differ by 0.7 % in
 * the mean from those of all cells, at the worst by 14 % (alum-bronze's blue, where all cells do not converge and the sample does).
 */
static bp_status colour_fit(const struct sample *sample, struct model *model, bp_error *error)
{
	for (int c = 0; c < 3; c++) {
		struct robust_fit fit;
		bp_status status = robust_fit(sample->x, sample->y[c], sample->n, &fit, error);
		if (status)
			return status;
		model->colour[c] = (struct colour_fit){.diffuse = fit.intercept, .specular = fit.slope, .iterations = fit.iterations,
		                                       .converged = fit.converged, .rejected = (double)fit.rejected / (double)sample->n};
	}
	return BP_OK;
}

/*
 * Where the logarithm turns linear: a hundredth of the geometric mean of the median and the 85 % point of all channels' values.
 * The median alone is too low for mirrors and too high for matte white, a higher point the other way round (VARIANTS.md).
 * What lies below 2^-24 of the largest value counts as that: so the unit is at least 2^-31 of the largest, and where half of a
 * table is dark it does not hang on how dark. Square roots are exact to the last bit, powers would not be. Rearranges the sample.
 */
static double unit_for(struct sample *sample, double largest)
{
	double *v = sample->y[0];
	const size_t last = 3 * sample->n - 1, half = last / 2, high = last / 20 * 17 + last % 20 * 17 / 20;
	const double least = largest * 0x1p-24;

	if (largest == 0)
		return 1;
	const double median = select_kth(v, last + 1, half);
	const double upper = select_kth(v + half, last + 1 - half, high - half);
	const double unit = sqrt(fmax(median, least)) * sqrt(fmax(upper, least)) / 100;
	return fmin(fmax(unit, DEFAULT_UNIT_LEAST), DEFAULT_UNIT_MOST);
}

/* The channels by the sums of their values: from here on it does not matter which is called red. */
static void channels_order(const struct sample *sample, int order[3])
{
	double sum[3] = {0};
	for (int c = 0; c < 3; c++) {
		for (size_t i = 0; i < sample->n; i++)
			sum[c] += sample->y[c][i];
		int at = c;
		for (; at > 0 && sum[order[at - 1]] < sum[c]; at--)
			order[at] = order[at - 1];
		order[at] = c;
	}
}

static double largest_value(const struct lattice *lattice)
{
	const size_t cells = lattice_cells(lattice->dims);
	double largest = 0;
	for (int c = 0; c < 3; c++)
		largest = fmax(largest, kernels_get()->default_largest(lattice->rgb[c], lattice->valid, cells));
	return largest;
}

/* The three tables of logarithms, still channels in the order given, become the spectra of the fields. */
static bp_status fields_make(struct lattice_dims d, struct spectrum *spectrum, const int order[3], bool denoise, struct default_model *fitted,
                             bp_error *error)
{
	const size_t rows = (size_t)d.theta_h * d.theta_d;
	float rotation[3][3]; /* of the channels in that order */
	bp_status status = BP_OK;

	stage_enter(STAGE_TRANSFORM);
	for (int k = 0; k < 3; k++)
		spectrum_forward(spectrum, fitted->coefficient[k], fitted->base[order[k]]);
	rotation_find(fitted->coefficient, rows, d.phi_d, rotation);
	for (size_t r = 0; r < rows; r++) {
		float *const x[3] = {fitted->coefficient[0] + r * d.phi_d, fitted->coefficient[1] + r * d.phi_d, fitted->coefficient[2] + r * d.phi_d};
		kernels_get()->default_rotate(x, d.phi_d, (const float(*)[3])rotation);
	}
	for (int f = 0; f < 3; f++)
		for (int k = 0; k < 3; k++)
			fitted->rotation[f][order[k]] = rotation[f][k];
	stage_enter(STAGE_CLEAN);
	for (int f = 0; !status && f < 3 && denoise; f++)
		status = default_denoise(d, fitted->coefficient[f], &fitted->noisy, error);
	return status;
}

/* Steps of default_project by effort 1..9: what the first saves, 3 % of a record, costs a sixth of a fit. */
static const int PROJECTIONS[9] = {0, 0, 0, 0, 0, 1, 2, 4, 8};

/* fields_make after better values have been found for the invalid cells; noise would only be carried on into them. */
static bp_status fields_improve(const struct lattice *lattice, const struct fit_options *options, struct spectrum *spectrum, const int order[3],
                                const float *filled, struct default_model *fitted, bp_error *error)
{
	const float base[3] = {fitted->base[order[0]], fitted->base[order[1]], fitted->base[order[2]]};
	bp_status status;

	memcpy(fitted->coefficient[0], filled, 3 * lattice_cells(lattice->dims) * sizeof *filled);
	stage_enter(STAGE_CLEAN);
	status = default_project(spectrum, lattice->dims, lattice->valid, base, options->budget_bytes, PROJECTIONS[options->effort - 1],
	                         fitted->coefficient, error);
	return status ? status : fields_make(lattice->dims, spectrum, order, true, fitted, error);
}

bp_status default_fit(const struct lattice *lattice, const struct fit_options *options, struct model *model, bp_error *error)
{
	const struct kernels *kernels = kernels_get();
	const struct lattice_dims d = lattice->dims;
	const size_t cells = lattice_cells(d);
	/* An error bound is a promise about the measured values, their noise included. */
	const bool denoise = !(options->max_error > 0), project = denoise && PROJECTIONS[options->effort - 1] > 0;
	struct default_model *fitted = model->log_density = calloc(1, sizeof *fitted);
	struct spectrum *spectrum = NULL;
	struct sample sample = {0};
	float *filled = NULL;
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
	status = sample_draw(lattice, &sample, error);
	if (!status)
		status = colour_fit(&sample, model, error);
	stage_enter(STAGE_CLEAN);
	if (!status) {
		channels_order(&sample, order);
		fitted->unit = unit_for(&sample, largest_value(lattice));
		status = spectrum_create(d, &spectrum, error);
	}
	free(sample.x);
	for (int k = 0; !status && k < 3; k++) {
		const double sum = kernels->default_logs(lattice->rgb[order[k]], lattice->valid, cells, 1 / fitted->unit, fitted->coefficient[k]);
		fitted->base[order[k]] = (float)(sum / (double)lattice->valid_count);
	}
	if (!status)
		status = default_fill(d, lattice->valid, fitted->coefficient, error);
	if (!status && project) {
		filled = malloc(3 * cells * sizeof *filled);
		if (filled)
			memcpy(filled, fitted->coefficient[0], 3 * cells * sizeof *filled);
		else
			status = error_memory(error, 3 * cells * sizeof *filled);
	}
	if (!status)
		status = fields_make(d, spectrum, order, denoise, fitted, error);
	if (!status && project && !fitted->noisy && lattice->valid_count < cells)
		status = fields_improve(lattice, options, spectrum, order, filled, fitted, error);
	free(filled);
	spectrum_free(spectrum);
	return status;
}
