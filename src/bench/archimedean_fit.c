/*
 * archimedean_fit.c: a table becomes marginals and a copula.
 *
 *     means along each axis -> for every family and turn alpha, with two guesses of the offset -> for the best few alpha and
 *     the offset together -> the best of them with all cells of the sample
 */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>
#include <gsl/gsl_multimin.h>
#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "archimedean.h"
#include "lobe_sample.h"
#include "log_tensor.h"

enum { STRIDE_D = 6, STRIDE_P = 12, GRID = 10, ITERATIONS_MAX = 60 };
/* Every so many cells of the sample decide between families and turns; so many of these are refined before one is chosen. */
enum { COARSE = 8, COARSE_FROM = 8000, CANDIDATES = 5 };
static const double ALPHA_FIRST = 0.05, ALPHA_LAST = 25, PART_LAST = 0.98;

/* Of the channel's table with its holes filled. */
struct axis_means {
	double mean;                         /* 1/sr */
	double least;                        /* the smallest of the values below: the offset can be no more */
	double value[3][LATTICE_EXTENT_MAX]; /* over the other two axes, divided by the mean */
};

static void axis_means_take(struct lattice_dims dims, const double *plane, const uint32_t *source, struct axis_means *out)
{
	const size_t H = dims.theta_h, D = dims.theta_d, P = dims.phi_d;
	double sum = 0;

	*out = (struct axis_means){.least = 1};
	for (size_t i = 0; i < H; i++)
		for (size_t j = 0; j < D; j++)
			for (size_t k = 0; k < P; k++) {
				const double x = plane[source[(i * D + j) * P + k]];
				out->value[0][i] += x;
				out->value[1][j] += x;
				out->value[2][k] += x;
			}
	for (size_t i = 0; i < H; i++)
		sum += out->value[0][i];
	out->mean = sum / (double)(H * D * P);
	for (int axis = 0; axis < 3; axis++)
		for (uint32_t n = 0; n < archimedean_extent(dims, axis); n++) {
			double *value = &out->value[axis][n];
			*value = sum > 0 ? *value * archimedean_extent(dims, axis) / sum : 0;
			out->least = fmin(out->least, *value);
		}
}

/* The marginals of what is left when `offset` (in units of the mean, below 1) is taken off the table. */
static void marginals_set(struct lattice_dims dims, const struct axis_means *means, double offset,
                          struct archimedean_channel *out)
{
	for (int axis = 0; axis < 3; axis++)
		for (uint32_t n = 0; n < archimedean_extent(dims, axis); n++)
			out->marginal[axis][n] = means->mean > 0 ? (float)(fmax(0, means->value[axis][n] - offset) / (1 - offset)) : 0;
	archimedean_accumulate(dims, out);
}

struct search {
	const struct lobe_sample *sample;
	const double *rgb;
	struct lattice_dims dims;
	const struct axis_means *means;
	struct archimedean_channel *channel;             /* family, turns, marginals */
	size_t every;                                    /* of the sample's cells */
	double diffuse, scale;                           /* of the last evaluation, in the sample's unit */
	struct copula_edge edges[ARCHIMEDEAN_EDGES_MAX]; /* scratch */
};

/* The cosine-weighted squared error with the best diffuse and K, both >= 0. */
static double objective(double log_alpha, void *user)
{
	struct search *search = user;
	const struct lobe_sample *s = search->sample;
	const struct archimedean_channel *channel = search->channel;
	const uint32_t D = search->dims.theta_d, P = search->dims.phi_d;
	const struct copula_edge *edges[3];
	const double alpha = exp(log_alpha);
	const struct copula copula = copula_make(channel->family, alpha);
	double one = 0, y1 = 0, yy = 0, yg = 0, g1 = 0, gg = 0;

	const double cells =
		archimedean_edges(search->dims, channel, alpha, search->edges, edges) * (double)lattice_cells(search->dims);
	for (size_t n = 0; n < s->count; n += search->every) {
		uint32_t k = s->cell[n] % P, j = s->cell[n] / P % D, i = s->cell[n] / P / D;
		double g = fmax(0, cells * copula_cell_mass(&copula, edges[0] + i, edges[1] + j, edges[2] + k));
		double y = search->rgb[n], w = s->weight[n];
		one += w;
		y1 += w * y;
		yy += w * y * y;
		yg += w * y * g;
		g1 += w * g;
		gg += w * g * g;
	}
	if (!isfinite(gg))
		return HUGE_VAL;
	return yy - nonnegative_pair(one, g1, gg, y1, yg, &search->diffuse, &search->scale);
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
			if (gsl_min_fminimizer_x_upper(minimizer) - gsl_min_fminimizer_x_lower(minimizer) < 1e-2)
				break;
		*log_alpha = gsl_min_fminimizer_x_minimum(minimizer);
		best = gsl_min_fminimizer_f_minimum(minimizer);
	}
	if (minimizer)
		gsl_min_fminimizer_free(minimizer);
	return best;
}

struct candidate {
	enum archimedean_family family;
	unsigned turned;
	double error, log_alpha;
	double x; /* the offset as an unbounded number */
};

/* 0 to just below the least mean, where a marginal would be 0 somewhere. */
static double offset_of(const struct axis_means *means, double x) { return 0.999 * means->least * (x * x / (1 + x * x)); }

static void candidate_apply(struct search *search, const struct candidate *candidate)
{
	search->channel->family = candidate->family;
	search->channel->turned = candidate->turned;
	marginals_set(search->dims, search->means, offset_of(search->means, candidate->x), search->channel);
}

/*
 * Alpha for two offsets: none, and the diffuse part that came out with that. In a mostly diffuse table the
 * marginals hold too little of the lobe for the first to tell families and turns apart.
 */
static void candidate_find(struct search *search, double unit, struct candidate *candidate)
{
	const double room = search->means->least * search->means->mean;

	candidate->x = 0;
	candidate_apply(search, candidate);
	candidate->error = best_alpha(search, &candidate->log_alpha);
	objective(candidate->log_alpha, search);
	if (search->diffuse > 0 && room > 0) {
		struct candidate second = *candidate;
		const double part = fmin(PART_LAST, search->diffuse * unit / room);
		second.x = sqrt(part / (1 - part));
		candidate_apply(search, &second);
		second.error = best_alpha(search, &second.log_alpha);
		if (second.error < candidate->error)
			*candidate = second;
	}
}

struct refinement {
	struct search *search;
	struct candidate candidate;
};

static double refined_objective(const gsl_vector *at, void *user)
{
	struct refinement *refinement = user;

	refinement->candidate.log_alpha = gsl_vector_get(at, 0);
	refinement->candidate.x = gsl_vector_get(at, 1);
	if (!(refinement->candidate.log_alpha > log(ALPHA_FIRST / 10) && refinement->candidate.log_alpha < log(2 * ALPHA_LAST)))
		return HUGE_VAL;
	candidate_apply(refinement->search, &refinement->candidate);
	return objective(refinement->candidate.log_alpha, refinement->search);
}

/* Alpha and the offset together, by the simplex of Nelder and Mead (GSL). */
static void candidate_refine(struct search *search, struct candidate *candidate)
{
	struct refinement refinement = {search, *candidate};
	double start[2] = {candidate->log_alpha, candidate->x}, step[2] = {0.1, 0.2};
	gsl_vector_view at = gsl_vector_view_array(start, 2), steps = gsl_vector_view_array(step, 2);
	gsl_multimin_function function = {refined_objective, 2, &refinement};
	gsl_multimin_fminimizer *minimizer = gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, 2);

	if (minimizer && !gsl_multimin_fminimizer_set(minimizer, &function, &at.vector, &steps.vector)) {
		for (int n = 0; n < 2 * ITERATIONS_MAX && !gsl_multimin_fminimizer_iterate(minimizer); n++)
			if (gsl_multimin_fminimizer_size(minimizer) < 1e-4)
				break;
		candidate->log_alpha = gsl_vector_get(minimizer->x, 0);
		candidate->x = gsl_vector_get(minimizer->x, 1);
		candidate->error = minimizer->fval;
	}
	if (minimizer)
		gsl_multimin_fminimizer_free(minimizer);
}

/* The best first. */
static void candidate_insert(struct candidate list[CANDIDATES], struct candidate candidate)
{
	for (int n = 0; n < CANDIDATES; n++)
		if (candidate.error < list[n].error) {
			struct candidate worse = list[n];
			list[n] = candidate;
			candidate = worse;
		}
}

static void fit_channel(struct search *search, struct archimedean_channel *channel, double unit)
{
	struct candidate candidates[CANDIDATES], best = {.error = HUGE_VAL};

	search->channel = channel;
	search->every = search->sample->count >= COARSE_FROM ? COARSE : 1;
	for (int n = 0; n < CANDIDATES; n++)
		candidates[n] = best;
	for (int family = 0; family < ARCHIMEDEAN_FAMILIES; family++)
		for (unsigned turned = 0; turned < 8; turned++) {
			struct candidate candidate = {.family = (enum archimedean_family)family, .turned = turned};
			candidate_find(search, unit, &candidate);
			candidate_insert(candidates, candidate);
		}
	for (int n = 0; n < CANDIDATES; n++) {
		candidate_refine(search, &candidates[n]);
		if (candidates[n].error < best.error)
			best = candidates[n];
	}
	if (search->every > 1) {
		search->every = 1;
		candidate_refine(search, &best);
	}
	candidate_apply(search, &best);
	channel->alpha = (float)exp(best.log_alpha);
	objective(log((double)channel->alpha), search);
	channel->scale = (float)(search->scale * unit);
	channel->diffuse = (float)(search->diffuse * unit);
}

bp_status archimedean_fit(const struct baseline *self, const struct bench_material *material, struct fitted *out, bp_error *error)
{
	const struct lattice *lattice = material->lattice;
	const size_t cells = lattice_cells(lattice->dims);
	const uint32_t stride_d = lattice->dims.theta_d >= 60 ? STRIDE_D : 1, stride_p = lattice->dims.phi_d >= 60 ? STRIDE_P : 1;
	uint32_t *source = malloc(cells * sizeof *source);
	struct lobe_sample sample = {0};
	struct archimedean_state *state = calloc(1, sizeof *state);
	struct search *search = malloc(sizeof *search);
	struct axis_means *means = malloc(sizeof *means);
	bp_status status;

	(void)self;
	gsl_set_error_handler_off();
	if (!source || !state || !search || !means) {
		status = error_memory(error, cells * sizeof *source + sizeof *state + sizeof *search + sizeof *means);
		goto out;
	}
	state->dims = lattice->dims;
	if ((status = lattice_fill_sources(lattice, source, error)) ||
	    (status = lobe_sample_take(lattice, stride_d, stride_p, &sample, error)))
		goto out;
	*search = (struct search){.sample = &sample, .dims = lattice->dims, .means = means};
	for (int c = 0; c < 3; c++) {
		axis_means_take(lattice->dims, lattice->rgb[c], source, means);
		search->rgb = sample.rgb[c];
		fit_channel(search, &state->channel[c], sample.unit);
	}
	const size_t numbers = 3 * ((size_t)lattice->dims.theta_h + lattice->dims.theta_d + lattice->dims.phi_d + 3);
	*out = (struct fitted){state, numbers * sizeof(float) + 3, numbers};
	state = NULL;
out:
	lobe_sample_free(&sample);
	free(state);
	free(means);
	free(search);
	free(source);
	return status;
}
