#include "marginal.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "model/math/fast_math.h"
#include "paper.h"

static const float DARK = 3e-4f;  /* of a pixel's usual brightness: nobody sees how much darker */
static const double RANGE = 4.32; /* log2 20 */
static const double SHARED_WEIGHT = 0.1;
enum { ROUNDS = 8, TURNS = 3 }; /* of h and d by turns; of these and phi */

bp_status marginals_alloc(struct lattice_dims d, struct marginals *out, bp_error *error)
{
	const size_t pairs = (size_t)d.theta_h * d.theta_d, bytes = (paper_marginal_values(d) + 2 * pairs) * sizeof(float);

	out->h = malloc(bytes);
	if (!out->h)
		return error_memory(error, bytes);
	out->d = out->h + d.theta_h;
	out->phi = out->d + d.theta_d;
	out->rest = out->phi + d.phi_d;
	out->measured = out->rest + pairs;
	return BP_OK;
}

/* Sums of the logarithms and of their weights: of every pair (theta_h, theta_d) and of every phi_d. */
struct log_sums {
	double *pair, *pair_weight, *phi, *phi_weight; /* one block, at pair */
};

static double clamped(double x, double range) { return x > range ? range : x < -range ? -range : x; }

static void sums_gather(struct lattice_dims d, const float *value, const float *shown, struct log_sums *sums)
{
	float logs[LATTICE_EXTENT_MAX];

	for (uint32_t row = 0; row < d.theta_h * d.theta_d; row++) {
		const float *x = value + (size_t)row * d.phi_d, *s = shown + (size_t)row * d.phi_d;
		const double shared = row / d.theta_d < paper_shared_from(d.theta_h) ? 1 : SHARED_WEIGHT;
		double sum = 0, weight = 0;

		for (uint32_t k = 0; k < d.phi_d; k++)
			logs[k] = s[k] * fast_log2f(x[k] > DARK ? x[k] : DARK);
		for (uint32_t k = 0; k < d.phi_d; k++) {
			sum += (double)logs[k];
			weight += (double)s[k];
			sums->phi[k] += shared * (double)logs[k];
			sums->phi_weight[k] += shared * (double)s[k];
		}
		sums->pair[row] = shared * sum;
		sums->pair_weight[row] = shared * weight;
	}
}

/* What the others leave for one index, or the value before it where nothing was measured. */
static double mean_or(double sum, double weight, double otherwise) { return weight > 0 ? sum / weight : otherwise; }

/* One factor, of n values `step` pairs apart, from what m values of the other leave, `across` pairs apart. */
static void axis_fit(const struct log_sums *sums, uint32_t n, uint32_t step, uint32_t m, uint32_t across, const double *other,
                     double range, double *out)
{
	for (uint32_t a = 0; a < n; a++) {
		double sum = 0, weight = 0;
		for (uint32_t b = 0; b < m; b++) {
			const double w = sums->pair_weight[a * step + b * across];
			sum += sums->pair[a * step + b * across] - w * other[b];
			weight += w;
		}
		out[a] = clamped(mean_or(sum, weight, a ? out[a - 1] : 0), range);
	}
}

/* phi from what h and d leave. */
static void phi_fit(struct lattice_dims d, const float *shown, const struct log_sums *sums, const double *h, const double *j_mean,
                    double *phi)
{
	double explained[LATTICE_EXTENT_MAX] = {0};

	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const float *s = shown + lattice_index(d, i, j, 0);
			const double of_row = (i < paper_shared_from(d.theta_h) ? 1 : SHARED_WEIGHT) * (h[i] + j_mean[j]);
			for (uint32_t k = 0; k < d.phi_d; k++)
				explained[k] += of_row * (double)s[k];
		}
	for (uint32_t k = 0; k < d.phi_d; k++)
		phi[k] = clamped(mean_or(sums->phi[k] - explained[k], sums->phi_weight[k], 0), RANGE);
}

/* The sums of every pair change by -change[k] in each cell. */
static void pairs_lower(struct lattice_dims d, const float *shown, const double *change, struct log_sums *sums)
{
	for (uint32_t row = 0; row < d.theta_h * d.theta_d; row++) {
		const double shared = row / d.theta_d < paper_shared_from(d.theta_h) ? 1 : SHARED_WEIGHT;
		double sum = 0;
		for (uint32_t k = 0; k < d.phi_d; k++)
			sum += (double)shown[(size_t)row * d.phi_d + k] * change[k];
		sums->pair[row] -= shared * sum;
	}
}

static bool slice_is_black(struct lattice_dims d, const float *value, uint32_t i)
{
	const float *x = value + lattice_index(d, i, 0, 0);

	for (size_t n = 0; n < (size_t)d.theta_d * d.phi_d; n++)
		if (x[n] > 0)
			return false;
	return true;
}

bp_status marginals_fit(struct lattice_dims d, const float *value, const float *shown, struct marginals *out, bp_error *error)
{
	const size_t pairs = (size_t)d.theta_h * d.theta_d;
	struct log_sums sums;
	double h[LATTICE_EXTENT_MAX], j_mean[LATTICE_EXTENT_MAX] = {0};
	double phi[LATTICE_EXTENT_MAX], before[LATTICE_EXTENT_MAX] = {0}, change[LATTICE_EXTENT_MAX];

	sums.pair = calloc(2 * (pairs + d.phi_d), sizeof *sums.pair);
	if (!sums.pair)
		return error_memory(error, 2 * (pairs + d.phi_d) * sizeof *sums.pair);
	sums.pair_weight = sums.pair + pairs;
	sums.phi = sums.pair_weight + pairs;
	sums.phi_weight = sums.phi + d.phi_d;
	sums_gather(d, value, shown, &sums);
	for (int turn = 0; turn < TURNS; turn++) {
		for (int round = 0; round < ROUNDS; round++) {
			axis_fit(&sums, d.theta_h, d.theta_d, d.theta_d, 1, j_mean, INFINITY, h);
			axis_fit(&sums, d.theta_d, 1, d.theta_h, d.theta_d, h, RANGE, j_mean);
		}
		phi_fit(d, shown, &sums, h, j_mean, phi);
		for (uint32_t k = 0; k < d.phi_d; k++) {
			change[k] = phi[k] - before[k];
			before[k] = phi[k];
		}
		pairs_lower(d, shown, change, &sums);
	}
	for (uint32_t k = 0; k < d.phi_d; k++)
		out->phi[k] = (float)fast_exp2(phi[k]);
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const size_t at = (size_t)i * d.theta_d + j;
			const double w = sums.pair_weight[at];
			out->measured[at] = (float)w;
			out->rest[at] = w > 0 ? (float)fast_exp2(clamped(sums.pair[at] / w - h[i] - j_mean[j], RANGE)) : 1;
		}
	for (uint32_t i = 0; i < d.theta_h; i++)
		out->h[i] = slice_is_black(d, value, i) ? 0 : (float)fast_exp2(h[i]);
	for (uint32_t j = 0; j < d.theta_d; j++)
		out->d[j] = (float)fast_exp2(j_mean[j]);
	free(sums.pair);
	return BP_OK;
}
