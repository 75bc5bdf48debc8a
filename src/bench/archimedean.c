#include "archimedean.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>
#include <math.h>
#include <stdlib.h>

#include "../error.h"
#include "baseline.h"
#include "lobe_sample.h"
#include "log_tensor.h"

enum { STRIDE_D = 6, STRIDE_P = 12, GRID = 10, ITERATIONS_MAX = 60 };
static const double ALPHA_FIRST = 0.05, ALPHA_LAST = 25, EDGE = 1e-6;

/* What one coordinate contributes: Frank 1 - e^-alpha u and e^-alpha u; Clayton u^-alpha and u^-(alpha + 1). */
struct axis_term {
	double a, b;
};

static struct axis_term axis_term(enum archimedean_family family, double alpha, double u)
{
	if (family == ARCHIMEDEAN_FRANK)
		return (struct axis_term){-expm1(-alpha * u), exp(-alpha * u)};
	return (struct axis_term){pow(u, -alpha), pow(u, -alpha - 1)};
}

static double density_of(enum archimedean_family family, double alpha, struct axis_term x, struct axis_term y, struct axis_term z)
{
	if (family == ARCHIMEDEAN_FRANK) {
		double p = -expm1(-alpha), product = x.a * y.a * z.a, s = product / (p * p), rest = 1 - s;
		return alpha * alpha * s * (1 + s) / (rest * rest * rest) * (x.b * y.b * z.b) / product;
	}
	return (1 + alpha) * (1 + 2 * alpha) * (x.b * y.b * z.b) * pow(x.a + y.a + z.a - 2, -1 / alpha - 3);
}

double archimedean_density(enum archimedean_family family, double alpha, double u, double v, double w)
{
	return density_of(family, alpha, axis_term(family, alpha, u), axis_term(family, alpha, v), axis_term(family, alpha, w));
}

static uint32_t extent_of(struct lattice_dims dims, int axis)
{
	return axis == 0 ? dims.theta_h : axis == 1 ? dims.theta_d : dims.phi_d;
}

bp_status archimedean_alloc(struct lattice_dims dims, struct archimedean_state **out, bp_error *error)
{
	const size_t per_channel = (size_t)dims.theta_h + dims.theta_d + dims.phi_d;
	struct archimedean_state *state = calloc(1, sizeof *state);

	if (!state)
		return error_memory(error, sizeof *state);
	state->dims = dims;
	state->marginals = calloc(3 * per_channel, sizeof *state->marginals);
	state->cumulatives = calloc(3 * per_channel, sizeof *state->cumulatives);
	if (!state->marginals || !state->cumulatives) {
		archimedean_free(state);
		return error_memory(error, 3 * per_channel * (sizeof(float) + sizeof(double)));
	}
	for (size_t c = 0, at = 0; c < 3; c++)
		for (int axis = 0; axis < 3; axis++) {
			state->channel[c].marginal[axis] = state->marginals + at;
			state->channel[c].cumulative[axis] = state->cumulatives + at;
			at += extent_of(dims, axis);
		}
	*out = state;
	return BP_OK;
}

void archimedean_accumulate(struct archimedean_state *state)
{
	for (int c = 0; c < 3; c++)
		for (int axis = 0; axis < 3; axis++) {
			const uint32_t extent = extent_of(state->dims, axis);
			double sum = 0;
			for (uint32_t n = 0; n < extent; n++) {
				double f = (double)state->channel[c].marginal[axis][n] / extent;
				state->channel[c].cumulative[axis][n] = fmin(1 - EDGE, fmax(EDGE, sum + f / 2));
				sum += f;
			}
		}
}

void archimedean_free(void *opaque)
{
	struct archimedean_state *state = opaque;

	if (!state)
		return;
	free(state->marginals);
	free(state->cumulatives);
	free(state);
}

/* The mean of the filled channel, and its marginals relative to that. */
static void take_marginals(struct lattice_dims dims, const double *plane, const uint32_t *source, struct archimedean_channel *out)
{
	const size_t H = dims.theta_h, D = dims.theta_d, P = dims.phi_d;
	double sum_h, sum_d[LATTICE_EXTENT_MAX] = {0}, sum_p[LATTICE_EXTENT_MAX] = {0}, sum = 0;

	for (size_t i = 0; i < H; i++) {
		sum_h = 0;
		for (size_t j = 0; j < D; j++)
			for (size_t k = 0; k < P; k++) {
				double x = plane[source[(i * D + j) * P + k]];
				sum_h += x;
				sum_d[j] += x;
				sum_p[k] += x;
			}
		out->marginal[0][i] = (float)(sum_h / (double)(D * P));
		sum += sum_h;
	}
	double mean = sum / (double)(H * D * P);
	out->scale = (float)mean;
	for (size_t i = 0; i < H; i++)
		out->marginal[0][i] = mean > 0 ? (float)((double)out->marginal[0][i] / mean) : 0;
	for (size_t j = 0; j < D; j++)
		out->marginal[1][j] = mean > 0 ? (float)(sum_d[j] / (double)(H * P) / mean) : 0;
	for (size_t k = 0; k < P; k++)
		out->marginal[2][k] = mean > 0 ? (float)(sum_p[k] / (double)(H * D) / mean) : 0;
}

struct search {
	const struct lobe_sample *sample;
	const double *rgb;
	struct lattice_dims dims;
	const struct archimedean_channel *channel; /* family, turns, marginals */
	double diffuse, scale;                      /* of the last evaluation, in the sample's unit */
	struct axis_term terms[3 * LATTICE_EXTENT_MAX]; /* scratch */
};

static double axis_value(const struct archimedean_channel *channel, int axis, uint32_t n)
{
	double f = channel->cumulative[axis][n];

	return channel->turned >> axis & 1 ? 1 - f : f;
}

/* The terms of every cell along each axis, one after the other: H, D, P entries. */
static void axis_terms(struct lattice_dims dims, const struct archimedean_channel *channel, double alpha, struct axis_term *out)
{
	for (int axis = 0; axis < 3; axis++)
		for (uint32_t n = 0; n < extent_of(dims, axis); n++)
			*out++ = axis_term(channel->family, alpha, axis_value(channel, axis, n));
}

/* The cosine-weighted squared error with the best diffuse and K, both >= 0. */
static double objective(double log_alpha, void *user)
{
	struct search *search = user;
	const struct lobe_sample *s = search->sample;
	const struct archimedean_channel *channel = search->channel;
	const uint32_t D = search->dims.theta_d, P = search->dims.phi_d;
	const struct axis_term *term_d = search->terms + search->dims.theta_h, *term_p = term_d + D;
	double alpha = exp(log_alpha), y1 = 0, yy = 0, yg = 0, g1 = 0, gg = 0;

	axis_terms(search->dims, channel, alpha, search->terms);
	for (size_t n = 0; n < s->count; n++) {
		uint32_t k = s->cell[n] % P, j = s->cell[n] / P % D, i = s->cell[n] / P / D;
		double g = (double)(channel->marginal[0][i] * channel->marginal[1][j] * channel->marginal[2][k]) *
		           density_of(channel->family, alpha, search->terms[i], term_d[j], term_p[k]);
		double y = search->rgb[n], w = s->weight[n];
		y1 += w * y;
		yy += w * y * y;
		yg += w * y * g;
		g1 += w * g;
		gg += w * g * g;
	}
	if (!isfinite(gg))
		return HUGE_VAL;
	return yy - nonnegative_pair(1, g1, gg, y1, yg, &search->diffuse, &search->scale); /* the weights sum to 1 */
}

/* Grid over log alpha, then Brent's method (GSL) inside the best bracket. */
static double best_alpha(struct search *search, double *log_alpha)
{
	const double first = log(ALPHA_FIRST), last = log(ALPHA_LAST), step = (last - first) / (GRID - 1);
	double best = HUGE_VAL;
	int at = 0;

	for (int n = 0; n < GRID; n++) {
		double e = objective(first + n * step, search);
		if (e < best) {
			best = e;
			at = n;
		}
	}
	*log_alpha = first + at * step;
	if (at == 0 || at == GRID - 1)
		return best;
	gsl_function function = {objective, search};
	gsl_min_fminimizer *minimizer = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent);
	if (minimizer && !gsl_min_fminimizer_set(minimizer, &function, *log_alpha, *log_alpha - step, *log_alpha + step)) {
		for (int n = 0; n < ITERATIONS_MAX && !gsl_min_fminimizer_iterate(minimizer); n++)
			if (gsl_min_fminimizer_x_upper(minimizer) - gsl_min_fminimizer_x_lower(minimizer) < 1e-6)
				break;
		*log_alpha = gsl_min_fminimizer_x_minimum(minimizer);
		best = gsl_min_fminimizer_f_minimum(minimizer);
	}
	if (minimizer)
		gsl_min_fminimizer_free(minimizer);
	return best;
}

static void fit_channel(struct search *search, struct archimedean_channel *channel, double unit)
{
	struct archimedean_channel tried = *channel, best = *channel;
	double least = HUGE_VAL;

	search->channel = &tried;
	for (int family = 0; family < ARCHIMEDEAN_FAMILIES; family++)
		for (unsigned turned = 0; turned < 8; turned++) {
			double log_alpha, e;
			tried.family = (enum archimedean_family)family;
			tried.turned = turned;
			e = best_alpha(search, &log_alpha);
			if (!(e < least))
				continue;
			least = e;
			best = tried;
			best.alpha = (float)exp(log_alpha);
			objective(log((double)best.alpha), search);
			best.scale = (float)(search->scale * unit);
			best.diffuse = (float)(search->diffuse * unit);
		}
	search->channel = NULL;
	*channel = best;
}

static bp_status archimedean_fit(const struct bench_material *material, size_t budget_bytes, void **out, bp_error *error)
{
	const struct lattice *lattice = material->lattice;
	const size_t cells = lattice_cells(lattice->dims);
	const uint32_t stride_d = lattice->dims.theta_d >= 60 ? STRIDE_D : 1, stride_p = lattice->dims.phi_d >= 60 ? STRIDE_P : 1;
	uint32_t *source = malloc(cells * sizeof *source);
	struct lobe_sample sample = {0};
	struct archimedean_state *state = NULL;
	struct search *search = malloc(sizeof *search);
	bp_status status;

	(void)budget_bytes;
	gsl_set_error_handler_off();
	if (!source || !search) {
		status = error_memory(error, cells * sizeof *source + sizeof *search);
		goto out;
	}
	if ((status = lattice_fill_sources(lattice, source, error)) || (status = archimedean_alloc(lattice->dims, &state, error)) ||
	    (status = lobe_sample_take(lattice, stride_d, stride_p, &sample, error)))
		goto out;
	for (int c = 0; c < 3; c++)
		take_marginals(lattice->dims, lattice->rgb[c], source, &state->channel[c]);
	archimedean_accumulate(state);
	*search = (struct search){.sample = &sample, .dims = lattice->dims};
	for (int c = 0; c < 3; c++) {
		search->rgb = sample.rgb[c];
		fit_channel(search, &state->channel[c], sample.unit);
	}
	*out = state;
	state = NULL;
out:
	lobe_sample_free(&sample);
	archimedean_free(state);
	free(search);
	free(source);
	return status;
}

static size_t archimedean_parameters(const void *opaque)
{
	const struct lattice_dims dims = ((const struct archimedean_state *)opaque)->dims;

	return 3 * ((size_t)dims.theta_h + dims.theta_d + dims.phi_d + 3);
}

static size_t archimedean_bytes(const void *state)
{
	return archimedean_parameters(state) * sizeof(float) + 3;
}

static double finite_or_zero(double x)
{
	return isfinite(x) ? x : 0;
}

static bp_status archimedean_expand(const void *opaque, struct expansion *out, bp_error *error)
{
	const struct archimedean_state *state = opaque;
	const struct lattice_dims dims = state->dims;
	struct axis_term *terms = malloc(3 * LATTICE_EXTENT_MAX * sizeof *terms);
	const struct axis_term *term_d = terms + dims.theta_h, *term_p = term_d + dims.theta_d;

	if (!terms)
		return error_memory(error, 3 * LATTICE_EXTENT_MAX * sizeof *terms);
	out->unit = 1;
	for (int c = 0; c < 3; c++) {
		const struct archimedean_channel *channel = &state->channel[c];
		axis_terms(dims, channel, (double)channel->alpha, terms);
		for (uint32_t i = 0; i < dims.theta_h; i++)
			for (uint32_t j = 0; j < dims.theta_d; j++)
				for (uint32_t k = 0; k < dims.phi_d; k++) {
					double f = (double)(channel->scale * channel->marginal[0][i] * channel->marginal[1][j] * channel->marginal[2][k]);
					if (f > 0)
						f *= density_of(channel->family, (double)channel->alpha, terms[i], term_d[j], term_p[k]);
					out->rgb[c][lattice_index(dims, i, j, k)] = channel->diffuse + (float)finite_or_zero(f);
				}
	}
	free(terms);
	return BP_OK;
}

/* Marginals and their sums are interpolated linearly, phi_d up to its last corner. */
static void archimedean_evaluate(const void *opaque, const double wi[3], const double wo[3], double rgb[3])
{
	const struct archimedean_state *state = opaque;
	double at[3];

	lattice_coordinates(state->dims, wi, wo, at);
	for (int c = 0; c < 3; c++) {
		const struct archimedean_channel *channel = &state->channel[c];
		double f = (double)channel->scale, u[3];
		for (int axis = 0; axis < 3; axis++) {
			uint32_t n = (uint32_t)at[axis], next = n + 1 < extent_of(state->dims, axis) ? n + 1 : n;
			double x = at[axis] - n, f0 = (double)channel->marginal[axis][n], f1 = (double)channel->marginal[axis][next];
			double u0 = axis_value(channel, axis, n), u1 = axis_value(channel, axis, next);
			f *= f0 + x * (f1 - f0);
			u[axis] = u0 + x * (u1 - u0);
		}
		if (f > 0)
			f *= archimedean_density(channel->family, (double)channel->alpha, u[0], u[1], u[2]);
		rgb[c] = (double)channel->diffuse + finite_or_zero(f);
	}
}

const struct baseline BASELINE_ARCHIMEDEAN = {
	.name = "archimedean",
	.reference = "Ozturk et al. 2010, Frank or Clayton copula",
	.fit = archimedean_fit,
	.bytes = archimedean_bytes,
	.parameters = archimedean_parameters,
	.expand = archimedean_expand,
	.evaluate = archimedean_evaluate,
	.free_state = archimedean_free,
};
