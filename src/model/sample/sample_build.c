/* Building a sampler's tables from the values of a table. */
#include <stdlib.h>

#include "error.h"
#include "memory.h"
#include "sampler.h"

enum { SUB_PHI = 2, SUB_S = 3, SUBS = BINS * SUB_S };

/* Values at the sub-samples of one bin of phi: arrays of components, SUB_PHI x BINS x SUB_S. */
struct scratch {
	float sine_h[SUBS], cosine_h[SUBS]; /* of the half-angle, the same for every phi and node */
	float wi[3][SUB_PHI * SUBS], wo[3][SUB_PHI * SUBS], rgb[3][SUB_PHI * SUBS], weight[SUB_PHI * SUBS];
};

/* The 3-point Gauss rule: exact for polynomials of degree 5, which a highlight needs and midpoints are not. */
static const float GAUSS[SUB_S] = {0.112701665f, 0.5f, 0.887298335f};
static const double GAUSS_WEIGHT[SUB_S] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

/* weight: cos theta_i 4 (wo.h), or 0 below the horizon */
static void place(double theta, int phi, struct scratch *to)
{
	float ox = (float)sin(theta), oz = (float)cos(theta);
	for (int a = 0; a < SUB_PHI; a++) {
		double angle = (phi + (a + 0.5) / SUB_PHI) * 3.14159265358979324 / PHIS;
		/* both signs of phi take turns */
		float cx = (float)cos(angle), cy = (float)(a % 2 ? -sin(angle) : sin(angle));
		for (int m = 0; m < SUBS; m++) {
			int n = a * SUBS + m;
			float hz = to->cosine_h[m], hx = to->sine_h[m] * cx, hy = to->sine_h[m] * cy, dot = hx * ox + hz * oz;
			float z = 2 * dot * hz - oz;
			to->wi[0][n] = 2 * dot * hx - ox;
			to->wi[1][n] = 2 * dot * hy;
			to->wi[2][n] = z;
			to->wo[0][n] = ox;
			to->wo[1][n] = 0;
			to->wo[2][n] = oz;
			to->weight[n] = z > 0 ? 4 * dot * z : 0;
		}
	}
}

/* Turns densities per s into the cumulative distribution over the bins. */
static void accumulate(const struct sampler *p, const double *per_s, float *mass)
{
	double total = 0, sum = 0;
	for (int n = 0; n < BINS; n++)
		total += per_s[n] * (double)(p->s_edge[n + 1] - p->s_edge[n]);
	/* every bin keeps a little, so that what is left above any horizon can be divided by */
	double least = total > 0 ? 1e-3 * total / (double)p->s_edge[BINS] : 1;
	double scale = 1 / (total + least * (double)p->s_edge[BINS]);
	for (int n = 0; n < BINS; n++) {
		sum += (per_s[n] + least) * (double)(p->s_edge[n + 1] - p->s_edge[n]) * scale;
		mass[n + 1] = (float)sum;
	}
	mass[0] = 0;
	mass[BINS] = 1;
}

/* Returns the node's whole mass. flat: f is taken as 1. */
static double build_node(const struct table *table, struct sampler *p, int node, bool flat, struct scratch *scratch)
{
	double masses[PHIS], total = 0;
	for (int phi = 0; phi < PHIS; phi++) {
		double per_s[BINS], visible = 0, last = 0;
		place(node_theta(node), phi, scratch);
		table_evaluate_batch(table, SUB_PHI * SUBS, (const float *const[]){scratch->wi[0], scratch->wi[1], scratch->wi[2]},
		                     (const float *const[]){scratch->wo[0], scratch->wo[1], scratch->wo[2]},
		                     (float *const[]){scratch->rgb[0], scratch->rgb[1], scratch->rgb[2]});
		for (int n = 0; flat && n < 3 * SUB_PHI * SUBS; n++)
			scratch->rgb[n % 3][n / 3] = 1;
		for (int bin = 0; bin < BINS; bin++) {
			double sum[3] = {0, 0, 0}, ds = (double)(p->s_edge[bin + 1] - p->s_edge[bin]);
			double seen = 0;
			for (int a = 0; a < SUB_PHI; a++)
				for (int m = 0; m < SUB_S; m++) {
					int n = a * SUBS + bin * SUB_S + m;
					double share = GAUSS_WEIGHT[m] / SUB_PHI;
					seen += scratch->weight[n] > 0 ? share : 0;
					for (int c = 0; c < 3; c++)
						sum[c] += share * (double)scratch->rgb[c][n] * (double)scratch->weight[n];
				}
			double mean = (sum[0] + sum[1] + sum[2]) / 3;
			/* of the visible part; beyond the horizon the last one goes on, for wo that see farther */
			last = per_s[bin] = seen > 0 ? mean / seen : last;
			visible += mean * ds;
		}
		accumulate(p, per_s, p->s_mass[node][phi]);
		masses[phi] = visible;
		total += visible;
	}
	double sum = 0, least = total > 0 ? 1e-3 * total / PHIS : 1;
	for (int phi = 0; phi < PHIS; phi++) {
		sum += masses[phi] + least;
		p->phi_mass[node][phi + 1] = (float)(sum / (total + least * PHIS));
	}
	p->phi_mass[node][0] = 0;
	p->phi_mass[node][PHIS] = 1;
	return total;
}

static void guesses_make(struct sampler *p)
{
	p->guess[0] = 0;
	for (int at = 1, n = 0; at < GUESSES; at++) {
		float from = float_of_bits(0x33000000u + ((uint32_t)(at - 1) << 18));
		while (n < BINS - 1 && p->s_edge[n + 1] <= from)
			n++;
		p->guess[at] = (uint8_t)n;
	}
}

bp_status sampler_build(const struct table *table, struct sampler **out, bp_error *error)
{
	struct sampler *p = memory_alloc_kept(sizeof *p);
	struct scratch *scratch = malloc(sizeof *scratch);
	if (!p || !scratch) {
		memory_free_kept(p);
		free(scratch);
		return error_memory(error, sizeof *p + sizeof *scratch);
	}
	for (int n = 0; n <= BINS; n++) {
		double edge = (double)n / BINS;
		p->s_edge[n] = (float)(0.5 * edge * edge * edge * edge);
	}
	for (int n = 0; n < BINS; n++) {
		p->s_per[n] = 1 / (p->s_edge[n + 1] - p->s_edge[n]);
		p->s_next[n] = n + 1 < BINS ? p->s_edge[n + 1] : INFINITY;
	}
	guesses_make(p);
	for (int m = 0; m < SUBS; m++) {
		int bin = m / SUB_S;
		float s = p->s_edge[bin] + (p->s_edge[bin + 1] - p->s_edge[bin]) * GAUSS[m % SUB_S];
		scratch->sine_h[m] = 2 * sqrtf(s * (1 - s));
		scratch->cosine_h[m] = 1 - 2 * s;
	}
	for (int node = 0; node < NODES; node++)
		if (!(build_node(table, p, node, false, scratch) > 0)) /* black: as good as any, and samples stay well spread */
			build_node(table, p, node, true, scratch);
	free(scratch);
	*out = p;
	return BP_OK;
}

void sampler_free(struct sampler *sampler) { memory_free_kept(sampler); }

size_t sampler_bytes(const struct sampler *sampler) { return sizeof *sampler; }
