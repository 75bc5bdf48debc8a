#include "lobe.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>
#include <stdlib.h>

#include "error.h"
#include "lobe_sample.h"

enum { STARTS_KEPT = 3, ITERATIONS_MAX = 300, SAMPLES_D = 30, SAMPLES_P = 30, THIN = 3 };

struct search {
	const struct lobe_model *model;
	const struct lobe_sample *sample;
	double diffuse[3], specular[3]; /* of the last evaluation, in the sample's unit */
	double *lobe;                   /* the lobe's values at the sample's cells */
};

static void shape_from_free(const struct lobe_model *model, const double *x, double *shape)
{
	for (int n = 0; n < model->shape_count; n++)
		shape[n] = model->axis[n].map == LOBE_EXP ? exp(fmin(50, fmax(-50, x[n]))) : 1 / (1 + exp(-fmin(50, fmax(-50, x[n]))));
}

static double free_from_shape(const struct lobe_axis *axis, double shape)
{
	return axis->map == LOBE_EXP ? log(shape) : log(shape / (1 - shape));
}

/*
 * E^2 in the sample's unit, minimised over albedos >= 0 of the functions p = 1/pi and l = the lobe.
 */
static double project(struct search *search, const double *shape)
{
	const struct lobe_sample *s = search->sample;
	const double p = 1 / M_PI;
	double sum = 0;

	for (size_t n = 0; n < s->count; n++)
		search->lobe[n] = search->model->value(shape, s->angles[n]);
	for (int c = 0; c < 3; c++) {
		const double *weight = s->relative ? s->relative + (size_t)c * s->count : s->weight;
		double w0 = 0, l1 = 0, l2 = 0, y1 = 0, y2 = 0, yl = 0;
		for (size_t n = 0; n < s->count; n++) {
			const double w = weight[n], l = search->lobe[n], y = s->rgb[c][n];
			w0 += w;
			l1 += w * l;
			l2 += w * l * l;
			y1 += w * y;
			y2 += w * y * y;
			yl += w * y * l;
		}
		if (!isfinite(l2))
			return HUGE_VAL;
		sum += fmax(0, y2 - nonnegative_pair(p * p * w0, p * l1, l2, p * y1, yl, &search->diffuse[c], &search->specular[c]));
	}
	return sum;
}

static double objective(const gsl_vector *x, void *user)
{
	struct search *search = user;
	double shape[LOBE_SHAPE_MAX];

	shape_from_free(search->model, x->data, shape);
	/* the square root's minimum is a cusp at an exact fit, which the simplex follows to the last digit */
	return sqrt(project(search, shape));
}

static bp_status descend(struct search *search, double *x, double *best, bp_error *error)
{
	const size_t count = (size_t)search->model->shape_count;
	gsl_multimin_function function = {objective, count, search};
	gsl_multimin_fminimizer *minimizer = gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, count);
	gsl_vector *step = gsl_vector_alloc(count);
	gsl_vector_view start = gsl_vector_view_array(x, count);
	bp_status status = BP_OK;

	if (!minimizer || !step) {
		status = error_memory(error, count * count * sizeof(double));
		goto out;
	}
	/* the second round starts a fresh simplex at the first one's end: a collapsed simplex cannot fool it */
	for (int round = 0; round < 2; round++) {
		gsl_vector_set_all(step, round ? 0.05 : 0.3);
		if (gsl_multimin_fminimizer_set(minimizer, &function, &start.vector, step))
			break;
		for (int n = 0; n < ITERATIONS_MAX && !gsl_multimin_fminimizer_iterate(minimizer); n++)
			if (gsl_multimin_fminimizer_size(minimizer) < 1e-6)
				break;
		gsl_vector_memcpy(&start.vector, minimizer->x);
	}
	*best = minimizer->fval;
out:
	gsl_vector_free(step);
	if (minimizer)
		gsl_multimin_fminimizer_free(minimizer);
	return status;
}

struct start {
	double error, x[LOBE_SHAPE_MAX];
};

/* The best STARTS_KEPT points of the grid, in order; ties keep the earlier. */
static void search_grid(struct search *search, struct start *kept)
{
	const struct lobe_model *model = search->model;
	int at[LOBE_SHAPE_MAX] = {0};

	for (int n = 0; n < STARTS_KEPT; n++)
		kept[n].error = HUGE_VAL;
	for (;;) {
		struct start start;
		double shape[LOBE_SHAPE_MAX];
		int axis = 0;
		for (int n = 0; n < model->shape_count; n++) {
			const struct lobe_axis *a = &model->axis[n];
			double first = free_from_shape(a, a->first), last = free_from_shape(a, a->last);
			start.x[n] = first + (last - first) * at[n] / (a->steps - 1);
		}
		shape_from_free(model, start.x, shape);
		start.error = project(search, shape);
		for (int n = 0; n < STARTS_KEPT; n++)
			if (start.error < kept[n].error) {
				struct start swap = kept[n];
				kept[n] = start;
				start = swap;
			}
		while (axis < model->shape_count && ++at[axis] == model->axis[axis].steps)
			at[axis++] = 0;
		if (axis == model->shape_count)
			return;
	}
}

/* The shape as it is stored, and the albedos that go with it. */
static void state_fill(struct lobe_state *out, struct search *search, const double *x, double unit)
{
	double shape[LOBE_SHAPE_MAX];

	out->model = search->model;
	shape_from_free(out->model, x, shape);
	for (int a = 0; a < out->model->shape_count; a++)
		shape[a] = out->shape[a] = (float)shape[a];
	project(search, shape);
	for (int c = 0; c < 3; c++) {
		out->diffuse[c] = (float)(search->diffuse[c] * unit);
		out->specular[c] = (float)(search->specular[c] * unit);
	}
}

bp_status lobe_fit(const struct baseline *self, const struct bench_material *material, struct fitted *out, bp_error *error)
{
	const struct lobe_variant *variant = self->variant;
	const struct lattice *lattice = material->lattice;
	const uint32_t stride_d = (lattice->dims.theta_d + SAMPLES_D - 1) / SAMPLES_D;
	const uint32_t stride_p = (lattice->dims.phi_d + SAMPLES_P - 1) / SAMPLES_P;
	struct lobe_sample thin = {0}, dense = {0};
	struct search search = {.model = variant->model};
	struct start starts[STARTS_KEPT];
	struct lobe_state *state = calloc(1, sizeof *state);
	double best = HUGE_VAL;
	int chosen = 0;
	bp_status status;

	if (!state)
		return error_memory(error, sizeof *state);
	gsl_set_error_handler_off();
	if ((status = lobe_sample_take(lattice, stride_d, stride_p, &dense, error)))
		goto out;
	if ((status = lobe_sample_take(lattice, THIN * stride_d, THIN * stride_p, &thin, NULL)))
		thin = (struct lobe_sample){0}; /* so few valid cells: the dense sample serves for both */
	if (variant->objective == LOBE_RELATIVE && ((status = lobe_sample_make_relative(&dense, error)) ||
	                                            (thin.count && (status = lobe_sample_make_relative(&thin, error)))))
		goto out;
	search.lobe = malloc(dense.count * sizeof *search.lobe);
	if (!search.lobe) {
		status = error_memory(error, dense.count * sizeof *search.lobe);
		goto out;
	}
	search.sample = thin.count ? &thin : &dense;
	search_grid(&search, starts);
	for (int n = 0; n < STARTS_KEPT; n++) {
		double found = HUGE_VAL;
		if (isfinite(starts[n].error) && (status = descend(&search, starts[n].x, &found, error)))
			goto out;
		if (found < best) {
			best = found;
			chosen = n;
		}
	}
	search.sample = &dense;
	if ((status = descend(&search, starts[chosen].x, &best, error)))
		goto out;
	state_fill(state, &search, starts[chosen].x, dense.unit);
	const size_t numbers = 6 + (size_t)variant->model->shape_count;
	*out = (struct fitted){state, numbers * sizeof(float), numbers};
	state = NULL;
	status = BP_OK;
out:
	free(search.lobe);
	lobe_sample_free(&thin);
	lobe_sample_free(&dense);
	free(state);
	return status;
}

static double lobe_at(const struct lobe_state *state, struct cell_angles a)
{
	double shape[LOBE_SHAPE_MAX];

	for (int n = 0; n < state->model->shape_count; n++)
		shape[n] = state->shape[n];
	a.cos_i = fmax(a.cos_i, LOBE_COSINE_MIN);
	a.cos_o = fmax(a.cos_o, LOBE_COSINE_MIN);
	return state->model->value(shape, a);
}

bp_status lobe_expand(const void *opaque, struct expansion *out, bp_error *error)
{
	const struct lobe_state *state = opaque;
	const struct lattice_dims dims = out->dims;
	struct lattice_cosines tables;

	(void)error;
	lattice_centres(dims, &tables);
	out->unit = 1;
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++)
			for (uint32_t k = 0; k < dims.phi_d; k++) {
				size_t cell = lattice_index(dims, i, j, k);
				double lobe = lobe_at(state, cell_angles_at(&tables, i, j, k));
				for (int c = 0; c < 3; c++)
					out->rgb[c][cell] = (float)(state->diffuse[c] / M_PI + state->specular[c] * lobe);
			}
	return BP_OK;
}

void lobe_evaluate(const void *opaque, const double wi[3], const double wo[3], double rgb[3])
{
	const struct lobe_state *state = opaque;
	double lobe = lobe_at(state, cell_angles_of(wi, wo));

	for (int c = 0; c < 3; c++)
		rgb[c] = state->diffuse[c] / M_PI + state->specular[c] * lobe;
}
