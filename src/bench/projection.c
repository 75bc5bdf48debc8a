#include "projection.h"

#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"

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
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "eigenvalues of an unfolding: LAPACK dsyevd returned %d",
		                 (int)info);
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

/*
 * The Gram matrix of an unfolding whose axis has `extent` cells, each `run` values long without a break (theta_h, theta_d); the
 * upper triangle is enough for dsyevd.
 */
static void gram_runs(const struct log_tensor *t, size_t extent, size_t run, double *gram)
{
	const size_t cells = lattice_cells(t->dims);

	for (size_t a = 0; a < extent; a++)
		for (size_t b = a; b < extent; b++) {
			double sum = 0;
			for (int c = 0; c < 3; c++)
				for (size_t at = 0; at < cells; at += extent * run)
					sum += dot_float(t->plane[c] + at + a * run, t->plane[c] + at + b * run, run);
			gram[a * extent + b] = sum;
		}
}

/* The same for phi_d. */
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

bp_status projection_make(const struct log_tensor *t, struct projection *q, bp_error *error)
{
	const size_t H = t->dims.theta_h, D = t->dims.theta_d, P = t->dims.phi_d;
	const size_t most = H > D ? (H > P ? H : P) : (D > P ? D : P);
	bp_status status;

	q->h = H < RANK_MAX ? H : RANK_MAX;
	q->d = D < RANK_MAX ? D : RANK_MAX;
	q->p = P < RANK_MAX ? P : RANK_MAX;
	size_t count = 3 * q->h * q->d * q->p + H * q->h + D * q->d + P * q->p + most * most + (D + q->d) * q->p;
	q->core = malloc(count * sizeof *q->core);
	if (!q->core)
		return error_memory(error, count * sizeof *q->core);
	q->basis_h = q->core + 3 * q->h * q->d * q->p;
	q->basis_d = q->basis_h + H * q->h;
	q->basis_p = q->basis_d + D * q->d;
	double *gram = q->basis_p + P * q->p;
	gram_runs(t, H, D * P, gram);
	if ((status = leading_eigenvectors(gram, H, q->h, q->basis_h, error)))
		goto out;
	gram_runs(t, D, P, gram);
	if ((status = leading_eigenvectors(gram, D, q->d, q->basis_d, error)))
		goto out;
	gram_p(t, gram);
	if ((status = leading_eigenvectors(gram, P, q->p, q->basis_p, error)))
		goto out;
	project_core(t, q, gram + most * most, gram + most * most + D * q->p);
out:
	if (status)
		projection_free(q);
	return status;
}

void projection_free(struct projection *projection)
{
	free(projection->core);
	projection->core = NULL;
}

void projection_lift(const double *basis, size_t extent, size_t rank, const double *x, float *out, size_t stride)
{
	for (size_t n = 0; n < extent; n++) {
		double sum = 0;
		for (size_t r = 0; r < rank; r++)
			sum += basis[n * rank + r] * x[r];
		out[n * stride] = (float)sum;
	}
}
