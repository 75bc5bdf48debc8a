#include "tucker.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "angles.h"
#include "baseline.h"
#include "projection.h"

enum { SWEEPS_MAX = 60, INNER_SWEEPS = 4 };

/* Scales to length 1 and returns the length; a zero vector stays. */
static double normalise(double *x, size_t count)
{
	double sum = 0;

	for (size_t n = 0; n < count; n++)
		sum += x[n] * x[n];
	sum = sqrt(sum);
	for (size_t n = 0; sum > 0 && n < count; n++)
		x[n] /= sum;
	return sum;
}

struct term {
	double u[RANK_MAX], v[RANK_MAX], w[RANK_MAX], z[3], size;
};

/* plane[3][h][d]: the core along w. */
static void plane_take(const struct projection *q, const struct term *t, double *plane)
{
	for (size_t n = 0; n < 3 * q->h * q->d; n++) {
		const double *row = q->core + n * q->p;
		plane[n] = 0;
		for (size_t e = 0; e < q->p; e++)
			plane[n] += row[e] * t->w[e];
	}
}

/* w: the phi_d basis vector that carries most energy; v and z: the strongest row of the plane along it. */
static void term_start(const struct projection *q, struct term *t, double *plane)
{
	double energy[RANK_MAX] = {0}, best = -1;
	size_t most = 0, at = 0;

	for (size_t n = 0; n < 3 * q->h * q->d; n++)
		for (size_t e = 0; e < q->p; e++)
			energy[e] += q->core[n * q->p + e] * q->core[n * q->p + e];
	for (size_t e = 1; e < q->p; e++)
		if (energy[e] > energy[most])
			most = e;
	memset(t, 0, sizeof *t);
	t->w[most] = 1;
	plane_take(q, t, plane);
	for (size_t n = 0; n < 3 * q->h; n++) {
		double sum = 0;
		for (size_t b = 0; b < q->d; b++)
			sum += plane[n * q->d + b] * plane[n * q->d + b];
		if (sum > best) {
			best = sum;
			at = n;
		}
	}
	memcpy(t->v, plane + at * q->d, q->d * sizeof *t->v);
	normalise(t->v, q->d);
	for (int c = 0; c < 3; c++)
		t->z[c] = 1 / sqrt(3);
}

/* u, z and v that fit the plane better, each in its turn. */
static void plane_sweep(const struct projection *q, struct term *t, const double *plane)
{
	double along_v[3][RANK_MAX]; /* [colour][h] */

	for (size_t c = 0; c < 3; c++)
		for (size_t a = 0; a < q->h; a++) {
			double sum = 0;
			for (size_t b = 0; b < q->d; b++)
				sum += plane[(c * q->h + a) * q->d + b] * t->v[b];
			along_v[c][a] = sum;
		}
	for (size_t a = 0; a < q->h; a++)
		t->u[a] = along_v[0][a] * t->z[0] + along_v[1][a] * t->z[1] + along_v[2][a] * t->z[2];
	normalise(t->u, q->h);
	for (size_t c = 0; c < 3; c++) {
		t->z[c] = 0;
		for (size_t a = 0; a < q->h; a++)
			t->z[c] += along_v[c][a] * t->u[a];
	}
	normalise(t->z, 3);
	memset(t->v, 0, sizeof t->v);
	for (size_t c = 0; c < 3; c++)
		for (size_t a = 0; a < q->h; a++)
			for (size_t b = 0; b < q->d; b++)
				t->v[b] += t->z[c] * t->u[a] * plane[(c * q->h + a) * q->d + b];
	normalise(t->v, q->d);
}

/* The best rank-one term of the core by alternating least squares. plane[3][h][d] is scratch. */
static void best_term(const struct projection *q, struct term *t, double *plane)
{
	double previous = 0;

	term_start(q, t, plane);
	for (int sweep = 0; sweep < SWEEPS_MAX; sweep++) {
		if (sweep)
			plane_take(q, t, plane);
		for (int inner = 0; inner < INNER_SWEEPS; inner++)
			plane_sweep(q, t, plane);
		memset(t->w, 0, sizeof t->w);
		for (size_t c = 0; c < 3; c++)
			for (size_t a = 0; a < q->h; a++)
				for (size_t b = 0; b < q->d; b++) {
					const double *row = q->core + ((c * q->h + a) * q->d + b) * q->p;
					double x = t->z[c] * t->u[a] * t->v[b];
					for (size_t e = 0; e < q->p; e++)
						t->w[e] += x * row[e];
				}
		t->size = normalise(t->w, q->p);
		if (t->size <= previous * (1 + 1e-7))
			break;
		previous = t->size;
	}
}

static void deflate_core(struct projection *q, const struct term *t)
{
	for (size_t c = 0; c < 3; c++)
		for (size_t a = 0; a < q->h; a++)
			for (size_t b = 0; b < q->d; b++) {
				double *row = q->core + ((c * q->h + a) * q->d + b) * q->p, x = t->size * t->z[c] * t->u[a] * t->v[b];
				for (size_t e = 0; e < q->p; e++)
					row[e] -= x * t->w[e];
			}
}

bp_status tucker_decompose(const struct log_tensor *tensor, uint32_t terms, struct tucker_state **out, bp_error *error)
{
	const size_t H = tensor->dims.theta_h, D = tensor->dims.theta_d, P = tensor->dims.phi_d;
	struct projection q = {0};
	struct tucker_state *state = calloc(1, sizeof *state);
	float *values = calloc(terms * (H + D + P + 3), sizeof *values);
	double *plane = malloc(3 * RANK_MAX * RANK_MAX * sizeof *plane), first = 0;
	bp_status status;

	if (!state || !values || !plane) {
		status = error_memory(error, terms * (H + D + P + 3) * sizeof *values);
		goto out;
	}
	if ((status = projection_make(tensor, &q, error)))
		goto out;
	*state = (struct tucker_state){.dims = tensor->dims, .stride = terms, .u = values, .v = values + terms * H};
	state->w = state->v + terms * D;
	state->z = state->w + terms * P;
	values = NULL;
	for (uint32_t n = 0; n < terms; n++) {
		struct term term;
		best_term(&q, &term, plane);
		first = fmax(first, term.size);
		if (n && !(term.size > 1e-9 * first))
			break;
		deflate_core(&q, &term);
		projection_lift(q.basis_h, H, q.h, term.u, state->u + n, terms);
		projection_lift(q.basis_d, D, q.d, term.v, state->v + n, terms);
		projection_lift(q.basis_p, P, q.p, term.w, state->w + n, terms);
		for (uint32_t c = 0; c < 3; c++)
			state->z[c * terms + n] = (float)(term.size * term.z[c]);
		state->terms = n + 1;
	}
	*out = state;
	state = NULL;
out:
	projection_free(&q);
	free(plane);
	free(values);
	if (status)
		tucker_free(state);
	return status;
}

void tucker_free(void *opaque)
{
	struct tucker_state *state = opaque;

	if (state)
		free(state->u);
	free(state);
}

static bp_status tucker_fit(const struct baseline *self, const struct bench_material *material, struct fitted *out,
                            bp_error *error)
{
	const struct lattice_dims dims = material->lattice->dims;
	const size_t each = (size_t)dims.theta_h + dims.theta_d + dims.phi_d + 3,
				 terms = material->budget_bytes / (each * sizeof(float));
	struct tucker_state *state;
	struct log_tensor tensor;
	bp_status status = log_tensor_make(material->lattice, &tensor, error);

	(void)self;
	if (status)
		return status;
	status = tucker_decompose(&tensor, terms ? (uint32_t)terms : 1, &state, error);
	log_tensor_free(&tensor);
	if (!status)
		*out = (struct fitted){state, state->terms * each * sizeof(float), state->terms * each};
	return status;
}

static bp_status tucker_expand(const void *opaque, struct expansion *out, bp_error *error)
{
	const struct tucker_state *s = opaque;
	const size_t H = s->dims.theta_h, D = s->dims.theta_d, P = s->dims.phi_d, T = s->stride;
	float *row = malloc((T + 1) * P * sizeof *row), *w = row + P;

	if (!row)
		return error_memory(error, (T + 1) * P * sizeof *row);
	for (size_t t = 0; t < T; t++) /* phi_d fastest, for the loop below */
		for (size_t k = 0; k < P; k++)
			w[t * P + k] = s->w[k * T + t];
	out->unit = 1;
	for (size_t c = 0; c < 3; c++)
		for (size_t i = 0; i < H; i++)
			for (size_t j = 0; j < D; j++) {
				float *to = out->rgb[c] + (i * D + j) * P;
				memset(row, 0, P * sizeof *row);
				for (size_t t = 0; t < s->terms; t++) {
					float x = s->u[i * T + t] * s->v[j * T + t] * s->z[c * T + t];
					for (size_t k = 0; k < P; k++)
						row[k] += x * w[t * P + k];
				}
				for (size_t k = 0; k < P; k++)
					to[k] = log_tensor_value(row[k]);
			}
	free(row);
	return BP_OK;
}

/* The factors are interpolated linearly between centres, phi_d periodically. */
static void tucker_evaluate(const void *opaque, const double wi[3], const double wo[3], double rgb[3])
{
	enum { LANES = 4 };
	const struct tucker_state *s = opaque;
	const uint32_t H = s->dims.theta_h, D = s->dims.theta_d, P = s->dims.phi_d;
	const size_t T = s->stride;
	double at[3], x_h, x_d;
	float lane[3][LANES] = {{0}};

	lattice_coordinates(s->dims, wi, wo, at);
	const double along = at[2] < 0.5 ? at[2] + P - 0.5 : at[2] - 0.5;
	const uint32_t i = centre_before(at[0], H, &x_h), j = centre_before(at[1], D, &x_d), k = along < P ? (uint32_t)along : P - 1;
	const float *u0 = s->u + i * T, *u1 = i + 1 < H ? u0 + T : u0, *v0 = s->v + j * T, *v1 = j + 1 < D ? v0 + T : v0;
	const float *w0 = s->w + k * T, *w1 = k + 1 < P ? w0 + T : s->w;
	float a = (float)x_h, b = (float)x_d, e = (float)(along - k);
	for (size_t t = 0; t < s->terms; t++) {
		float x = (u0[t] + a * (u1[t] - u0[t])) * (v0[t] + b * (v1[t] - v0[t])) * (w0[t] + e * (w1[t] - w0[t]));
		for (size_t c = 0; c < 3; c++)
			lane[c][t % LANES] += x * s->z[c * T + t];
	}
	for (int c = 0; c < 3; c++)
		rgb[c] = (double)log_tensor_value(lane[c][0] + lane[c][1] + lane[c][2] + lane[c][3]);
}

const struct baseline BASELINE_TUCKER = {
	.reference = "Bilgili et al. 2011, repeated Tucker of the logarithm",
	.budgeted = true,
	.fit = tucker_fit,
	.expand = tucker_expand,
	.evaluate = tucker_evaluate,
	.free_state = tucker_free,
};
