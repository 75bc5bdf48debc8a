#include "pairs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "field.h"
#include "model/math/fast_math.h"
#include "paper_kernels.h"

enum { FREE_TURNS = 3, CODED_TURNS = 3, ROUNDS_FIRST = 4, STEPS = 8 };
static const float OWN_WEIGHT = 0.2f, OWN_WEIGHT_PHI = 0.1f; /* of cells below 40 degrees, beside the mean of those above */
static const double RIDGE = 1e-3;
static const float SHARED_MAX = 30; /* of a value that should be near 1 */
static const float FINE = 0.0625f;  /* step of the levels, beside the least coefficient that is worth keeping */

struct turns {
	struct channel_fit *channel;
	uint32_t from;
	float *a, *b;               /* theta_h x theta_d, theta_h x phi_d: A and B */
	float *a_weight, *b_weight; /* sums of weight (the rest of the product)^2 */
	float *wanted, *energy, *x[2], *numerator;
	uint8_t *kept;
};

static void turns_free(struct turns *t)
{
	free(t->a);
	free(t->x[0]);
	free(t->kept);
}

static bp_status turns_alloc(struct channel_fit *channel, const struct sparse_fit fit[2], struct turns *t, bp_error *error)
{
	const struct lattice_dims d = channel->dims;
	const size_t hd = (size_t)d.theta_h * d.theta_d, hp = (size_t)d.theta_h * d.phi_d;
	const size_t most = fit[0].coefficients > fit[1].coefficients ? fit[0].coefficients : fit[1].coefficients;
	const size_t slice = (size_t)d.theta_d * d.phi_d, floats = 2 * hd + 2 * hp + hd + hp + slice;

	*t = (struct turns){.channel = channel, .from = paper_shared_from(d.theta_h)};
	t->a = calloc(floats, sizeof *t->a);
	t->x[0] = calloc(fit[0].coefficients + fit[1].coefficients + most, sizeof *t->energy);
	t->kept = malloc(most);
	if (!t->a || !t->x[0] || !t->kept) {
		turns_free(t);
		return error_memory(error, floats * sizeof *t->a);
	}
	t->a_weight = t->a + hd;
	t->b = t->a_weight + hd;
	t->b_weight = t->b + hp;
	t->wanted = t->b_weight + hp;
	t->numerator = t->wanted + hd + hp;
	t->x[1] = t->x[0] + fit[0].coefficients;
	t->energy = t->x[1] + fit[1].coefficients;
	return BP_OK;
}

/* ---- least squares of one factor against the two others ---- */

static void a_update(struct turns *t)
{
	const struct channel_fit *c = t->channel;
	const struct lattice_dims d = c->dims;

	for (uint32_t i = t->from; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const size_t at = lattice_index(d, i, j, 0), to = (size_t)i * d.theta_d + j;
			double sums[2];
			paper_kernels_get()->fit_row(c->weight + at, c->value + at, t->b + (size_t)i * d.phi_d,
			                             c->shared + (size_t)j * d.phi_d, d.phi_d, sums);
			t->a[to] = sums[1] > 0 ? (float)(sums[0] / sums[1]) : 0;
			t->a_weight[to] = (float)sums[1];
		}
}

static void b_update(struct turns *t)
{
	const struct channel_fit *c = t->channel;
	const struct lattice_dims d = c->dims;

	for (uint32_t i = t->from; i < d.theta_h; i++) {
		float *numerator = t->b + (size_t)i * d.phi_d, *denominator = t->b_weight + (size_t)i * d.phi_d;
		memset(numerator, 0, d.phi_d * sizeof *numerator);
		memset(denominator, 0, d.phi_d * sizeof *denominator);
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const size_t at = lattice_index(d, i, j, 0);
			paper_kernels_get()->fit_columns(c->weight + at, c->value + at, t->a[(size_t)i * d.theta_d + j],
			                                 c->shared + (size_t)j * d.phi_d, d.phi_d, numerator, denominator);
		}
		for (uint32_t k = 0; k < d.phi_d; k++)
			numerator[k] = denominator[k] > 0 ? numerator[k] / denominator[k] : c->marginal.phi[k];
	}
}

/* The slice is drawn a little towards 1, so that it does not grow where A and B are next to nothing. */
static void shared_update(struct turns *t)
{
	struct channel_fit *c = t->channel;
	const struct lattice_dims d = c->dims;
	const size_t n = (size_t)d.theta_d * d.phi_d;
	double mean = 0;

	memset(t->numerator, 0, n * sizeof *t->numerator);
	memset(c->shared_weight, 0, n * sizeof *c->shared_weight);
	for (uint32_t i = t->from; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const size_t at = lattice_index(d, i, j, 0), to = (size_t)j * d.phi_d;
			paper_kernels_get()->fit_columns(c->weight + at, c->value + at, t->a[(size_t)i * d.theta_d + j],
			                                 t->b + (size_t)i * d.phi_d, d.phi_d, t->numerator + to, c->shared_weight + to);
		}
	for (size_t k = 0; k < n; k++)
		mean += (double)c->shared_weight[k] / (double)n;
	const float ridge = (float)(RIDGE * mean);
	for (size_t k = 0; k < n; k++) {
		const float v = ridge > 0 ? (t->numerator[k] + ridge) / (c->shared_weight[k] + ridge) : 1;
		c->shared[k] = v < SHARED_MAX ? v : SHARED_MAX;
	}
}

/* ---- marginals ---- */

/* From 40 degrees on f_h makes c_hd 1 in the geometric mean; then every marginal gets the mean 1, and is rounded as stored. */
static void marginals_settle(struct turns *t)
{
	struct channel_fit *c = t->channel;
	const struct lattice_dims d = c->dims;
	float *const f[3] = {c->marginal.h, c->marginal.d, c->marginal.phi};
	const uint32_t extents[3] = {d.theta_h, d.theta_d, d.phi_d};

	for (uint32_t i = t->from; i < d.theta_h; i++) {
		double sum = 0, weight = 0;
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const float a = t->a[(size_t)i * d.theta_d + j];
			const double w = (double)t->a_weight[(size_t)i * d.theta_d + j] * (double)a * (double)a;
			if (a > 0) {
				sum += w * fast_log2((double)(a / c->marginal.d[j]));
				weight += w;
			}
		}
		if (weight > 0 && c->marginal.h[i] > 0)
			c->marginal.h[i] = (float)fast_exp2(sum / weight);
	}
	double level = 1;
	for (int axis = 0; axis < 3; axis++) {
		double mean = 0;
		for (uint32_t i = 0; i < extents[axis]; i++)
			mean += (double)f[axis][i] / extents[axis];
		for (uint32_t i = 0; i < extents[axis]; i++)
			f[axis][i] = mean > 0 ? paper_coded(paper_code((float)((double)f[axis][i] / mean))) : 1;
		level *= mean;
		if (axis == 2 && mean > 0) { /* B loses this factor, so A has it */
			for (size_t at = (size_t)t->from * d.theta_d; at < (size_t)d.theta_h * d.theta_d; at++) {
				t->a[at] *= (float)mean;
				t->a_weight[at] /= (float)(mean * mean);
			}
		}
	}
	c->level = (float)level;
}

/* ---- coding ---- */

/* c_hd = A/(K f_h f_d) from 40 degrees on, what is left of the geometric means below; t->a_weight becomes its weights. */
static void hd_wanted(struct turns *t)
{
	const struct channel_fit *c = t->channel;
	const struct lattice_dims d = c->dims;
	double mean = 0;

	for (uint32_t i = t->from; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const size_t at = (size_t)i * d.theta_d + j;
			const float f = c->level * c->marginal.h[i] * c->marginal.d[j], y = f > 0 && t->a_weight[at] > 0 ? t->a[at] / f : 1;
			t->wanted[at] = y < FIELD_PAIR_MIN ? FIELD_PAIR_MIN : y < FIELD_VALUE_MAX ? y : FIELD_VALUE_MAX;
			t->a_weight[at] *= f * f;
			mean += (double)t->a_weight[at];
		}
	mean /= (double)(d.theta_h - t->from) * d.theta_d;
	const float own = OWN_WEIGHT * (mean > 0 ? (float)mean : 1) * 3 / (float)d.phi_d;
	for (size_t at = 0; at < (size_t)t->from * d.theta_d; at++) {
		t->wanted[at] = c->marginal.rest[at];
		t->a_weight[at] = own * c->marginal.measured[at];
	}
}

static void hphi_wanted(struct turns *t)
{
	const struct channel_fit *c = t->channel;
	const struct lattice_dims d = c->dims;
	double mean = 0;

	for (uint32_t i = t->from; i < d.theta_h; i++)
		for (uint32_t k = 0; k < d.phi_d; k++) {
			const size_t at = (size_t)i * d.phi_d + k;
			const float f = c->marginal.phi[k], y = t->b[at] / f;
			t->wanted[at] = y < FIELD_PAIR_MIN ? FIELD_PAIR_MIN : y < FIELD_VALUE_MAX ? y : FIELD_VALUE_MAX;
			t->b_weight[at] *= f * f;
			mean += (double)t->b_weight[at];
		}
	mean /= (double)(d.theta_h - t->from) * d.phi_d;
	for (size_t at = 0; at < (size_t)t->from * d.phi_d; at++) {
		t->wanted[at] = 1;
		t->b_weight[at] = OWN_WEIGHT_PHI * (mean > 0 ? (float)mean : 1);
	}
}

/* Codes t->wanted by its coefficients; `value` becomes what they decode to. In the last turn *out gets them. */
static bp_status pair_code(struct turns *t, struct sparse_fit *fit, enum paper_field kind, const float *weight, bool first,
                           bool last, float *value, struct sparse_field *out, bp_error *error)
{
	const struct lattice_dims d = t->channel->dims;
	float *x = t->x[kind];
	struct field_codec *codec = NULL;

	if (sparse_fit_is_one(fit, t->wanted, weight)) {
		for (size_t i = 0; i < fit->cells; i++)
			value[i] = 1;
		*out = (struct sparse_field){.count = 0};
		return BP_OK;
	}
	const float least = sparse_fit_energies(fit, weight, t->energy);
	const float edge = sparse_fit_rounds(fit, t->wanted, weight, t->energy, least, paper_keep(d, kind), first ? ROUNDS_FIRST : 1,
	                                     STEPS, t->kept, x);
	if (!last) {
		wavelet_inverse(&fit->plane, x, value, fit->scratch);
		for (size_t i = 0; i < fit->cells; i++)
			value[i] = value[i] > FIELD_PAIR_MIN ? value[i] : FIELD_PAIR_MIN;
		return BP_OK;
	}
	bp_status status = sparse_fit_quantise(fit, t->wanted, weight, t->energy, least, FINE * sqrtf(edge), x, out, error);
	status = status ? status : field_codec_create(d, kind, &codec, error);
	if (!status)
		field_expand(codec, out, value);
	field_codec_free(codec);
	return status;
}

static void a_from_hd(struct turns *t)
{
	const struct channel_fit *c = t->channel;
	const struct lattice_dims d = c->dims;

	for (uint32_t i = t->from; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++)
			t->a[(size_t)i * d.theta_d + j] = c->level * c->marginal.h[i] * c->marginal.d[j] * c->hd[(size_t)i * d.theta_d + j];
}

static void b_from_hphi(struct turns *t)
{
	const struct channel_fit *c = t->channel;
	const struct lattice_dims d = c->dims;

	for (uint32_t i = t->from; i < d.theta_h; i++)
		for (uint32_t k = 0; k < d.phi_d; k++)
			t->b[(size_t)i * d.phi_d + k] = c->marginal.phi[k] * c->hphi[(size_t)i * d.phi_d + k];
}

bp_status pairs_fit(struct channel_fit *c, struct sparse_fit fit[2], struct sparse_field *hd, struct sparse_field *hphi,
                    bp_error *error)
{
	const struct lattice_dims d = c->dims;
	struct turns t;
	bp_status status = turns_alloc(c, fit, &t, error);

	if (status)
		return status;
	for (uint32_t i = t.from; i < d.theta_h; i++)
		memcpy(t.b + (size_t)i * d.phi_d, c->marginal.phi, d.phi_d * sizeof *t.b);
	for (size_t n = 0; n < (size_t)d.theta_d * d.phi_d; n++)
		c->shared[n] = 1;
	a_update(&t);
	for (int turn = 0; turn < FREE_TURNS; turn++) {
		b_update(&t);
		shared_update(&t);
		a_update(&t);
	}
	marginals_settle(&t);
	for (int turn = 0; !status && turn < CODED_TURNS; turn++) {
		const bool last = turn == CODED_TURNS - 1;
		if (turn)
			a_update(&t);
		hd_wanted(&t);
		status = pair_code(&t, &fit[0], PAPER_HD, t.a_weight, !turn, last, c->hd, hd, error);
		if (status)
			break;
		a_from_hd(&t);
		b_update(&t);
		hphi_wanted(&t);
		status = pair_code(&t, &fit[1], PAPER_HPHI, t.b_weight, !turn, last, c->hphi, hphi, error);
		b_from_hphi(&t);
		shared_update(&t);
	}
	turns_free(&t);
	return status;
}
