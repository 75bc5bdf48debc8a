#include "slices.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "paper_kernels.h"

enum { STEPS = 6 };
static const float LEAST_WEIGHT =
	0.01f; /* of a measured cell, beside the slice's mean: of its relative error where it is brighter than usual */
static const float MISSING_WEIGHT = 0.001f; /* of a cell that was not: it is drawn to the slice's mean */
static const float FINE = 0.0625f;

struct slices {
	struct sparse_target *target; /* [count] */
	float *fields;                /* of the targets */
	float *x, *gain;              /* [count][coefficients] */
	uint8_t *kept;                /* likewise */
};

static void slices_free(struct slices *s)
{
	free(s->target);
	free(s->fields);
	free(s->x);
	free(s->kept);
}

static bp_status slices_alloc(uint32_t count, const struct sparse_fit *fit, struct slices *s, bp_error *error)
{
	const size_t each = 2 * fit->cells + fit->coefficients, coefficients = count * fit->coefficients;

	s->target = malloc(count * sizeof *s->target);
	s->fields = malloc(count * each * sizeof *s->fields);
	s->x = calloc(2 * coefficients, sizeof *s->x);
	s->kept = malloc(coefficients);
	if (!s->target || !s->fields || !s->x || !s->kept)
		return error_memory(error, (count * each + 2 * coefficients) * sizeof *s->x);
	s->gain = s->x + coefficients;
	for (uint32_t i = 0; i < count; i++) {
		float *wanted = s->fields + i * each;
		s->target[i] = (struct sparse_target){wanted, wanted + fit->cells, wanted + 2 * fit->cells, 0};
	}
	return BP_OK;
}

/* A few cells of nearly no weight could cost a slice its coefficients' meaning: nowhere is it less than a share of the mean. */
static void weights_settle(float *wanted, float *weight, size_t n)
{
	double sum = 0, moment = 0;

	for (size_t i = 0; i < n; i++) {
		sum += (double)weight[i];
		moment += (double)(weight[i] * wanted[i]);
	}
	if (!(sum > 0))
		return;
	const float usual = (float)(moment / sum), mean = (float)(sum / (double)n), bright = usual > 0 ? 1 / usual : 0;
	for (size_t i = 0; i < n; i++) {
		const float r = wanted[i] * bright, least = LEAST_WEIGHT * mean / (r > 1 ? r * r : 1);
		if (!(weight[i] > 0)) {
			wanted[i] = usual;
			weight[i] = MISSING_WEIGHT * mean;
		} else if (weight[i] < least) {
			weight[i] = least;
		}
	}
}

/* What slice i should be, and how much each cell of it matters. */
static void slice_wanted(const struct channel_fit *c, uint32_t i, float *wanted, float *weight)
{
	const struct lattice_dims d = c->dims;
	const size_t n = (size_t)d.theta_d * d.phi_d;
	float column[LATTICE_EXTENT_MAX];

	if (i == paper_shared_from(d.theta_h)) {
		memcpy(wanted, c->shared, n * sizeof *wanted);
		memcpy(weight, c->shared_weight, n * sizeof *weight);
	} else {
		for (uint32_t k = 0; k < d.phi_d; k++)
			column[k] = c->marginal.phi[k] * c->hphi[(size_t)i * d.phi_d + k];
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const float row = c->level * c->marginal.h[i] * c->marginal.d[j] * c->hd[(size_t)i * d.theta_d + j];
			const size_t at = lattice_index(d, i, j, 0), to = (size_t)j * d.phi_d;
			paper_kernels_get()->quotients(c->weight + at, c->value + at, row, column, d.phi_d, wanted + to, weight + to);
		}
		for (size_t k = 0; k < n; k++)
			wanted[k] = wanted[k] < FIELD_VALUE_MAX ? wanted[k] : FIELD_VALUE_MAX;
	}
	weights_settle(wanted, weight, n);
}

bp_status slices_fit(const struct channel_fit *c, struct sparse_fit *fit, struct sparse_field *slice, bp_error *error)
{
	const uint32_t count = paper_shared_from(c->dims.theta_h) + 1, keep = paper_keep(c->dims, PAPER_SLICE);
	const size_t n = fit->coefficients;
	struct slices s = {.x = NULL};
	bp_status status = slices_alloc(count, fit, &s, error);

	for (uint32_t i = count; !status && i-- > 0;) {
		float *x = s.x + i * n;
		slice_wanted(c, i, s.target[i].wanted, s.target[i].weight);
		if (i + 1 < count)
			memcpy(x, x + n, n * sizeof *x);
		sparse_fit_energies(fit, &s.target[i]);
		sparse_fit_rounds(fit, &s.target[i], keep / count, i + 1 < count ? 1 : 2, STEPS, s.kept, x);
		sparse_fit_gains(fit, &s.target[i], x, s.gain + i * n);
	}
	const float unit = status ? 0 : FINE * sqrtf(gains_keep(s.gain, count * n, keep, s.kept));
	for (uint32_t i = 0; !status && i < count; i++) {
		float *x = s.x + i * n;
		sparse_fit_gradient(fit, &s.target[i], x);
		sparse_fit_refine(fit, &s.target[i], s.kept + i * n, STEPS, x);
		status = sparse_fit_quantise(fit, &s.target[i], unit, x, &slice[i], error);
	}
	slices_free(&s);
	return status;
}
