#include "pairs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "model/math/fast_math.h"
#include "paper_kernels.h"

enum { FREE_TURNS = 3, CODED_TURNS = 3, ROUNDS_FIRST = 4, STEPS = 8 };
static const float OWN_WEIGHT = 0.2f, OWN_WEIGHT_PHI = 0.1f; /* of cells below 40 degrees, beside the mean of those above */
static const double RIDGE = 1e-3;
static const float SHARED_MAX = 30; /* of a value that should be near 1 */
static const float FINE = 0.0625f;  /* step of the levels, beside the least coefficient that is worth keeping */

/* c_hd with A, or c_hphi with B. */
struct pair {
	enum paper_field kind;
	uint32_t columns; /* theta_d or phi_d */
	struct sparse_fit *fit;
	float *product, *weight; /* theta_h x columns: A or B, and the sums of weight (the rest of the product)^2 */
	float *value;            /* likewise: the copula as it decodes */
	float *x;                /* its coefficients, from turn to turn */
	struct sparse_field *out;
};

struct turns {
	struct channel_fit *channel;
	uint32_t from;
	struct pair hd, hphi;
	float *wanted, *energy, *numerator;
	uint8_t *kept;
};

static void turns_free(struct turns *t)
{
	free(t->hd.product);
	free(t->kept);
}

static bp_status turns_alloc(struct channel_fit *channel, struct sparse_fit fit[2], struct sparse_field *hd,
                             struct sparse_field *hphi, struct turns *t, bp_error *error)
{
	const struct lattice_dims d = channel->dims;
	const size_t hd_cells = (size_t)d.theta_h * d.theta_d, hphi_cells = (size_t)d.theta_h * d.phi_d;
	const size_t most = fit[0].coefficients > fit[1].coefficients ? fit[0].coefficients : fit[1].coefficients;
	const size_t slice = (size_t)d.theta_d * d.phi_d, coefficients = fit[0].coefficients + fit[1].coefficients + most;
	const size_t floats = 3 * (hd_cells + hphi_cells) + slice + coefficients;
	float *block = calloc(floats, sizeof *block);

	*t = (struct turns){
		.channel = channel,
		.from = paper_shared_from(d.theta_h),
		.hd = {PAPER_HD, d.theta_d, &fit[0], block, NULL, channel->hd, NULL, hd},
		.hphi = {PAPER_HPHI, d.phi_d, &fit[1], NULL, NULL, channel->hphi, NULL, hphi},
		.kept = malloc(most),
	};
	if (!block || !t->kept) {
		turns_free(t);
		return error_memory(error, floats * sizeof *block);
	}
	t->hd.weight = block + hd_cells;
	t->hphi.product = t->hd.weight + hd_cells;
	t->hphi.weight = t->hphi.product + hphi_cells;
	t->wanted = t->hphi.weight + hphi_cells;
	t->numerator = t->wanted + hd_cells + hphi_cells;
	t->hd.x = t->numerator + slice;
	t->hphi.x = t->hd.x + fit[0].coefficients;
	t->energy = t->hphi.x + fit[1].coefficients;
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
			paper_kernels_get()->fit_row(c->weight + at, c->value + at, t->hphi.product + (size_t)i * d.phi_d,
			                             c->shared + (size_t)j * d.phi_d, d.phi_d, sums);
			t->hd.product[to] = sums[1] > 0 ? (float)(sums[0] / sums[1]) : 0;
			t->hd.weight[to] = (float)sums[1];
		}
}

static void b_update(struct turns *t)
{
	const struct channel_fit *c = t->channel;
	const struct lattice_dims d = c->dims;

	for (uint32_t i = t->from; i < d.theta_h; i++) {
		float *numerator = t->hphi.product + (size_t)i * d.phi_d, *denominator = t->hphi.weight + (size_t)i * d.phi_d;
		memset(numerator, 0, d.phi_d * sizeof *numerator);
		memset(denominator, 0, d.phi_d * sizeof *denominator);
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const size_t at = lattice_index(d, i, j, 0);
			paper_kernels_get()->fit_columns(c->weight + at, c->value + at, t->hd.product[(size_t)i * d.theta_d + j],
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
			paper_kernels_get()->fit_columns(c->weight + at, c->value + at, t->hd.product[(size_t)i * d.theta_d + j],
			                                 t->hphi.product + (size_t)i * d.phi_d, d.phi_d, t->numerator + to,
			                                 c->shared_weight + to);
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
			const float a = t->hd.product[(size_t)i * d.theta_d + j];
			const double w = (double)t->hd.weight[(size_t)i * d.theta_d + j] * (double)a * (double)a;
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
				t->hd.product[at] *= (float)mean;
				t->hd.weight[at] /= (float)(mean * mean);
			}
		}
	}
	c->level = (float)level;
}

/* ---- coding ---- */

/* What a copula is multiplied by to give A or B. */
static float marginals_at(const struct channel_fit *c, enum paper_field kind, uint32_t row, uint32_t column)
{
	return kind == PAPER_HD ? c->level * c->marginal.h[row] * c->marginal.d[column] : c->marginal.phi[column];
}

/*
 * The copula from 40 degrees on, and p->weight as its weights. Below, c_hd is what is left of the geometric means, and c_hphi
 * is 1.
 */
static void pair_wanted(struct turns *t, struct pair *p)
{
	const struct channel_fit *c = t->channel;
	const uint32_t rows = c->dims.theta_h;
	double mean = 0;

	for (uint32_t i = t->from; i < rows; i++)
		for (uint32_t n = 0; n < p->columns; n++) {
			const size_t at = (size_t)i * p->columns + n;
			const float f = marginals_at(c, p->kind, i, n), y = f > 0 && p->weight[at] > 0 ? p->product[at] / f : 1;
			t->wanted[at] = y < FIELD_PAIR_MIN ? FIELD_PAIR_MIN : y < FIELD_VALUE_MAX ? y : FIELD_VALUE_MAX;
			p->weight[at] *= f * f;
			mean += (double)p->weight[at];
		}
	mean /= (double)(rows - t->from) * p->columns;
	const float usual = mean > 0 ? (float)mean : 1;
	const float own = p->kind == PAPER_HD ? OWN_WEIGHT * usual * 3 / (float)c->dims.phi_d : OWN_WEIGHT_PHI * usual;
	for (size_t at = 0; at < (size_t)t->from * p->columns; at++) {
		t->wanted[at] = p->kind == PAPER_HD ? c->marginal.rest[at] : 1;
		p->weight[at] = p->kind == PAPER_HD ? own * c->marginal.measured[at] : own;
	}
}

/* Codes t->wanted by its coefficients; p->value becomes what they decode to. In the last turn *p->out gets them. */
static bp_status wanted_code(struct turns *t, struct pair *p, bool first, bool last, bp_error *error)
{
	struct sparse_target target = {t->wanted, p->weight, t->energy, 0};
	struct field_codec *codec = NULL;

	if (sparse_fit_is_one(p->fit, &target)) {
		for (size_t i = 0; i < p->fit->cells; i++)
			p->value[i] = 1;
		*p->out = (struct sparse_field){.count = 0};
		return BP_OK;
	}
	sparse_fit_energies(p->fit, &target);
	const uint32_t keep = paper_keep(t->channel->dims, p->kind);
	const float edge = sparse_fit_rounds(p->fit, &target, keep, first ? ROUNDS_FIRST : 1, STEPS, t->kept, p->x);
	if (!last) {
		wavelet_inverse(&p->fit->plane, p->x, p->value, p->fit->scratch);
		for (size_t i = 0; i < p->fit->cells; i++)
			p->value[i] = p->value[i] > FIELD_PAIR_MIN ? p->value[i] : FIELD_PAIR_MIN;
		return BP_OK;
	}
	bp_status status = sparse_fit_quantise(p->fit, &target, FINE * sqrtf(edge), p->x, p->out, error);
	status = status ? status : field_codec_create(t->channel->dims, p->kind, &codec, error);
	if (!status)
		field_expand(codec, p->out, p->value);
	free(codec);
	return status;
}

/* The copula that comes nearest to A or B, and A or B by it. */
static bp_status pair_code(struct turns *t, struct pair *p, bool first, bool last, bp_error *error)
{
	pair_wanted(t, p);
	const bp_status status = wanted_code(t, p, first, last, error);
	for (uint32_t i = t->from; i < t->channel->dims.theta_h && !status; i++)
		for (uint32_t n = 0; n < p->columns; n++) {
			const size_t at = (size_t)i * p->columns + n;
			p->product[at] = marginals_at(t->channel, p->kind, i, n) * p->value[at];
		}
	return status;
}

bp_status pairs_fit(struct channel_fit *c, struct sparse_fit fit[2], struct sparse_field *hd, struct sparse_field *hphi,
                    bp_error *error)
{
	const struct lattice_dims d = c->dims;
	struct turns t;
	bp_status status = turns_alloc(c, fit, hd, hphi, &t, error);

	if (status)
		return status;
	for (uint32_t i = t.from; i < d.theta_h; i++)
		memcpy(t.hphi.product + (size_t)i * d.phi_d, c->marginal.phi, d.phi_d * sizeof(float));
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
		status = pair_code(&t, &t.hd, !turn, last, error);
		if (status)
			break;
		b_update(&t);
		status = pair_code(&t, &t.hphi, !turn, last, error);
		shared_update(&t);
	}
	turns_free(&t);
	return status;
}
