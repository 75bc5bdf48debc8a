#include "tucker.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "angles.h"
#include "baseline.h"

enum { RANK_MAX = 40, SWEEPS_MAX = 60, INNER_SWEEPS = 4 };

/* The projected tensor: core[c][a][b][e], colour slowest, and each axis's basis, row-major extent x rank. */
struct projection {
	size_t h, d, p;
	double *core, *basis_h, *basis_d, *basis_p;
};

/*
 * The leading `rank` eigenvectors of a symmetric positive matrix, largest first. gram[extent][extent] is
 * overwritten; basis[extent][rank].
 */
static bp_status leading_eigenvectors(double *gram, size_t extent, size_t rank, double *basis, bp_error *error)
{
	double *values = malloc(extent * sizeof *values);
	lapack_int info;

	if (!values)
		return error_memory(error, extent * sizeof *values);
	info = LAPACKE_dsyevd(LAPACK_ROW_MAJOR, 'V', 'U', (lapack_int)extent, gram, (lapack_int)extent, values);
	free(values);
	if (info)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "eigenvalues of an unfolding: LAPACK dsyevd returned %d", (int)info);
	for (size_t n = 0; n < extent; n++)
		for (size_t r = 0; r < rank; r++)
			basis[n * rank + r] = gram[n * extent + extent - 1 - r];
	return BP_OK;
}

static double dot_float(const float *a, const float *b, size_t count)
{
	double lane[8] = {0}, sum = 0;
	size_t n = 0;

	for (; n + 8 <= count; n += 8)
		for (int l = 0; l < 8; l++)
			lane[l] += (double)a[n + (size_t)l] * b[n + (size_t)l];
	for (; n < count; n++)
		sum += (double)a[n] * b[n];
	for (int l = 0; l < 8; l++)
		sum += lane[l];
	return sum;
}

/* Gram matrices of the three unfoldings; the upper triangle is enough for dsyevd. */
static void gram_h(const struct log_tensor *t, double *gram)
{
	const size_t H = t->dims.theta_h, slice = (size_t)t->dims.theta_d * t->dims.phi_d;

	for (size_t a = 0; a < H; a++)
		for (size_t b = a; b < H; b++) {
			double sum = 0;
			for (int c = 0; c < 3; c++)
				sum += dot_float(t->plane[c] + a * slice, t->plane[c] + b * slice, slice);
			gram[a * H + b] = sum;
		}
}

static void gram_d(const struct log_tensor *t, double *gram)
{
	const size_t H = t->dims.theta_h, D = t->dims.theta_d, P = t->dims.phi_d;

	for (size_t a = 0; a < D; a++)
		for (size_t b = a; b < D; b++) {
			double sum = 0;
			for (int c = 0; c < 3; c++)
				for (size_t i = 0; i < H; i++)
					sum += dot_float(t->plane[c] + (i * D + a) * P, t->plane[c] + (i * D + b) * P, P);
			gram[a * D + b] = sum;
		}
}

static void gram_p(const struct log_tensor *t, double *gram)
{
	const size_t rows = (size_t)t->dims.theta_h * t->dims.theta_d, P = t->dims.phi_d;

	memset(gram, 0, P * P * sizeof *gram);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < rows; n++) {
			const float *row = t->plane[c] + n * P;
			for (size_t a = 0; a < P; a++) {
				double x = row[a], *out = gram + a * P;
				for (size_t b = a; b < P; b++)
					out[b] += x * row[b];
			}
		}
}

static void project_core(const struct log_tensor *t, struct projection *q, double *by_p, double *by_d)
{
	const size_t H = t->dims.theta_h, D = t->dims.theta_d, P = t->dims.phi_d;

	memset(q->core, 0, 3 * q->h * q->d * q->p * sizeof *q->core);
	for (size_t c = 0; c < 3; c++)
		for (size_t i = 0; i < H; i++) {
			memset(by_p, 0, D * q->p * sizeof *by_p);
			memset(by_d, 0, q->d * q->p * sizeof *by_d);
			for (size_t j = 0; j < D; j++)
				for (size_t k = 0; k < P; k++) {
					double x = t->plane[c][(i * D + j) * P + k];
					for (size_t e = 0; e < q->p; e++)
						by_p[j * q->p + e] += x * q->basis_p[k * q->p + e];
				}
			for (size_t j = 0; j < D; j++)
				for (size_t b = 0; b < q->d; b++) {
					double x = q->basis_d[j * q->d + b];
					for (size_t e = 0; e < q->p; e++)
						by_d[b * q->p + e] += x * by_p[j * q->p + e];
				}
			for (size_t a = 0; a < q->h; a++) {
				double x = q->basis_h[i * q->h + a], *out = q->core + (c * q->h + a) * q->d * q->p;
				for (size_t n = 0; n < q->d * q->p; n++)
					out[n] += x * by_d[n];
			}
		}
}

static bp_status projection_make(const struct log_tensor *t, struct projection *q, double **memory, bp_error *error)
{
	const size_t H = t->dims.theta_h, D = t->dims.theta_d, P = t->dims.phi_d;
	const size_t most = H > D ? (H > P ? H : P) : (D > P ? D : P);
	size_t count;
	double *gram;
	bp_status status;

	q->h = H < RANK_MAX ? H : RANK_MAX;
	q->d = D < RANK_MAX ? D : RANK_MAX;
	q->p = P < RANK_MAX ? P : RANK_MAX;
	count = 3 * q->h * q->d * q->p + H * q->h + D * q->d + P * q->p + most * most + (D + q->d) * q->p;
	q->core = malloc(count * sizeof *q->core);
	if (!q->core)
		return error_memory(error, count * sizeof *q->core);
	*memory = q->core;
	q->basis_h = q->core + 3 * q->h * q->d * q->p;
	q->basis_d = q->basis_h + H * q->h;
	q->basis_p = q->basis_d + D * q->d;
	gram = q->basis_p + P * q->p;
	gram_h(t, gram);
	if ((status = leading_eigenvectors(gram, H, q->h, q->basis_h, error)))
		return status;
	gram_d(t, gram);
	if ((status = leading_eigenvectors(gram, D, q->d, q->basis_d, error)))
		return status;
	gram_p(t, gram);
	if ((status = leading_eigenvectors(gram, P, q->p, q->basis_p, error)))
		return status;
	project_core(t, q, gram + most * most, gram + most * most + D * q->p);
	return BP_OK;
}

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

/*
 * The best rank-one term of the core by alternating least squares, from the phi_d basis vector that carries most energy.
 * plane[3][h][d] is scratch.
 */
static void best_term(const struct projection *q, struct term *t, double *plane)
{
	double energy[RANK_MAX] = {0}, previous = 0;
	size_t rows = 3 * q->h * q->d, most = 0;

	for (size_t n = 0; n < rows; n++)
		for (size_t e = 0; e < q->p; e++)
			energy[e] += q->core[n * q->p + e] * q->core[n * q->p + e];
	for (size_t e = 1; e < q->p; e++)
		if (energy[e] > energy[most])
			most = e;
	memset(t, 0, sizeof *t);
	t->w[most] = 1;
	for (int sweep = 0; sweep < SWEEPS_MAX; sweep++) {
		for (size_t n = 0; n < rows; n++) {
			const double *row = q->core + n * q->p;
			double sum = 0;
			for (size_t e = 0; e < q->p; e++)
				sum += row[e] * t->w[e];
			plane[n] = sum;
		}
		if (!sweep) { /* start u, v, z at the plane's strongest row */
			double best = -1;
			size_t at = 0;
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
		for (int inner = 0; inner < INNER_SWEEPS; inner++) {
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

/* Back from a basis to the axis: every `stride`-th entry of out. */
static void lift(const double *basis, size_t extent, size_t rank, const double *x, float *out, size_t stride)
{
	for (size_t n = 0; n < extent; n++) {
		double sum = 0;
		for (size_t r = 0; r < rank; r++)
			sum += basis[n * rank + r] * x[r];
		out[n * stride] = (float)sum;
	}
}

bp_status tucker_decompose(const struct log_tensor *tensor, uint32_t terms, struct tucker_state **out, bp_error *error)
{
	const size_t H = tensor->dims.theta_h, D = tensor->dims.theta_d, P = tensor->dims.phi_d;
	struct projection q = {0};
	struct tucker_state *state = calloc(1, sizeof *state);
	float *values = calloc(terms * (H + D + P + 3), sizeof *values);
	double *plane = malloc(3 * RANK_MAX * RANK_MAX * sizeof *plane), *memory = NULL, first = 0;
	bp_status status;

	if (!state || !values || !plane) {
		status = error_memory(error, terms * (H + D + P + 3) * sizeof *values);
		goto out;
	}
	if ((status = projection_make(tensor, &q, &memory, error)))
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
		lift(q.basis_h, H, q.h, term.u, state->u + n, terms);
		lift(q.basis_d, D, q.d, term.v, state->v + n, terms);
		lift(q.basis_p, P, q.p, term.w, state->w + n, terms);
		for (uint32_t c = 0; c < 3; c++)
			state->z[c * terms + n] = (float)(term.size * term.z[c]);
		state->terms = n + 1;
	}
	*out = state;
	state = NULL;
out:
	free(memory);
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

static size_t floats_per_term(struct lattice_dims dims)
{
	return (size_t)dims.theta_h + dims.theta_d + dims.phi_d + 3;
}

static bp_status tucker_fit(const struct bench_material *material, size_t budget_bytes, void **state, bp_error *error)
{
	size_t terms = budget_bytes / (floats_per_term(material->lattice->dims) * sizeof(float));
	struct tucker_state *out;
	struct log_tensor tensor;
	bp_status status = log_tensor_make(material->lattice, &tensor, error);

	if (status)
		return status;
	status = tucker_decompose(&tensor, terms ? (uint32_t)terms : 1, &out, error);
	log_tensor_free(&tensor);
	if (!status)
		*state = out;
	return status;
}

static size_t tucker_parameters(const void *opaque)
{
	const struct tucker_state *state = opaque;

	return state->terms * floats_per_term(state->dims);
}

static size_t tucker_bytes(const void *state)
{
	return tucker_parameters(state) * sizeof(float);
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

/* The factors are interpolated linearly, phi_d periodically. */
static void tucker_evaluate(const void *opaque, const double wi[3], const double wo[3], double rgb[3])
{
	enum { LANES = 4 };
	const struct tucker_state *s = opaque;
	const uint32_t H = s->dims.theta_h, D = s->dims.theta_d, P = s->dims.phi_d;
	const size_t T = s->stride;
	double at[3];
	float lane[3][LANES] = {{0}};

	lattice_coordinates(s->dims, wi, wo, at);
	uint32_t i = (uint32_t)at[0], j = (uint32_t)at[1], k = (uint32_t)at[2];
	const float *u0 = s->u + i * T, *u1 = i + 1 < H ? u0 + T : u0, *v0 = s->v + j * T, *v1 = j + 1 < D ? v0 + T : v0;
	const float *w0 = s->w + k * T, *w1 = k + 1 < P ? w0 + T : s->w;
	float a = (float)(at[0] - i), b = (float)(at[1] - j), e = (float)(at[2] - k);
	for (size_t t = 0; t < s->terms; t++) {
		float x = (u0[t] + a * (u1[t] - u0[t])) * (v0[t] + b * (v1[t] - v0[t])) * (w0[t] + e * (w1[t] - w0[t]));
		for (size_t c = 0; c < 3; c++)
			lane[c][t % LANES] += x * s->z[c * T + t];
	}
	for (int c = 0; c < 3; c++)
		rgb[c] = (double)log_tensor_value(lane[c][0] + lane[c][1] + lane[c][2] + lane[c][3]);
}

const struct baseline BASELINE_TUCKER = {
	.name = "tucker",
	.reference = "Bilgili et al. 2011, repeated Tucker of the logarithm",
	.budgeted = true,
	.fit = tucker_fit,
	.bytes = tucker_bytes,
	.parameters = tucker_parameters,
	.expand = tucker_expand,
	.evaluate = tucker_evaluate,
	.free_state = tucker_free,
};
