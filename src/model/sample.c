#include "sample.h"

#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "direction.h"

enum { NODES = 40, PHIS_ROOT = 4, PHIS = PHIS_ROOT * PHIS_ROOT, BINS_ROOT = 8, BINS = BINS_ROOT * BINS_ROOT };
enum { SUB_PHI = 2, SUB_S = 3, SUBS = BINS * SUB_S };

#define PI_F 3.14159265f
#define COSINE_SHARE 0.06f

struct sampler {
	float s_edge[BINS + 1], s_per[BINS]; /* edges of the bins, and 1 / their widths */
	float phi_mass[NODES][PHIS + 1];      /* cumulative mass at the edges of the bins of |phi_h|: 0, ..., 1 */
	float s_mass[NODES][PHIS][BINS + 1];  /* conditional on phi, cumulative at the edges of s, not cut at the horizon: 0, ..., 1 */
};

/* ---- Geometry ---- */

/* Where between the nodes an angle lies: dense at grazing. cosine = 0 is the last node. */
static float node_coordinate(float sine, float cosine)
{
	return (NODES - 1) * (1 - sqrtf(quarter_turns(cosine, sine)));
}

static double node_theta(int node)
{
	double rest = 1 - (double)node / (NODES - 1);
	/* exactly at grazing nothing is visible: the last node stands a little above */
	return (1 - fmax(rest * rest, 1e-4)) * 1.5707963267948966;
}

/* The largest s at which wi is above the horizon, for wo at (sine, cosine) and cos phi_h. */
static inline float horizon_s(float sine, float cosine, float cos_phi)
{
	float forward = sine * cos_phi, q2 = forward * forward + cosine * cosine;
	/* 1 + |sin psi| and 1 - |sin psi|, the latter without cancellation; sin^2 theta_max = (1 + sin psi)/2 */
	float big = 1 + fabsf(forward) / sqrtf(q2), small = cosine * cosine / (q2 * big);
	/* exchanged where cos phi < 0; by bits, because no branch predictor would guess it */
	uint32_t change = (bits_of_float(big) ^ bits_of_float(small)) & (0 - (bits_of_float(cos_phi) >> 31));
	float more = float_of_bits(bits_of_float(big) ^ change), less = float_of_bits(bits_of_float(small) ^ change);
	return 0.25f * more / (1 + sqrtf(0.5f * less));
}

static inline int s_bin(float s)
{
	int n = (int)(BINS * sqrtf(sqrtf(2 * s)));
	return n < BINS ? n : BINS - 1;
}

/* sin and cos of t quarter turns, t in [0, 2]; absolute error below 2e-7. Chebyshev fits about t = 1. */
static inline void sine_cosine(float t, float *sine, float *cosine)
{
	float x = t - 1, q = x * x;
	*cosine = -x * ((((0.000151671704f * q - 0.00467414384f) * q + 0.0796899183f) * q - 0.64596376f) * q + 1.57079632f);
	*sine = ((((-2.38241524e-05f * q + 0.000917722924f) * q - 0.0208626867f) * q + 0.253669322f) * q - 1.23370053f) * q + 1;
}

/* wo normalised, with the sine of its polar angle, the unit vector of its azimuth ((1, 0) at the pole), and its place between two nodes. */
struct outgoing {
	float x, y, z, sine, ex, ey;
	int node;    /* this one and the next */
	float share; /* of the next */
};

static inline float squared_length(const float w[3])
{
	return w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
}

static inline bool outgoing_set(const float wo[3], struct outgoing *o)
{
	float squared = squared_length(wo);
	if (!direction_usable(wo[2], squared, wo[2], squared))
		return false;
	float n = direction_normaliser(squared);
	o->x = wo[0] * n;
	o->y = wo[1] * n;
	/* nearer to grazing, squares of the cosine would leave a float's range */
	o->z = wo[2] * n > 1e-6f ? wo[2] * n : 1e-6f;
	o->sine = sqrtf(o->x * o->x + o->y * o->y);
	bool pole = !(o->sine > 0);
	o->ex = pole ? 1 : o->x / o->sine;
	o->ey = pole ? 0 : o->y / o->sine;
	float at = node_coordinate(o->sine, o->z);
	int node = (int)at;
	o->node = node < NODES - 1 ? node : NODES - 2;
	o->share = at - (float)o->node;
	return true;
}

/* ---- Density ---- */

/* Where s lies: its bin, and the share of the bin below it. */
struct cut {
	int bin;
	float share;
};

static inline struct cut cut_at(const struct sampler *p, float s)
{
	int n = s_bin(s);
	float t = (s - p->s_edge[n]) * p->s_per[n];
	t = t > 0 ? t : 0;
	return (struct cut){n, t < 1 ? t : 1};
}

/* The cumulative conditional there. */
static inline float cumulative(const float *mass, struct cut cut)
{
	return mass[cut.bin] + (mass[cut.bin + 1] - mass[cut.bin]) * cut.share;
}

/* Density over (s, |phi| in units of bins) at one node, for a horizon at `top`. */
static inline float node_density(const struct sampler *p, int node, int phi, int bin, struct cut top)
{
	const float *marginal = p->phi_mass[node], *mass = p->s_mass[node][phi];
	return (marginal[phi + 1] - marginal[phi]) * (mass[bin + 1] - mass[bin]) / cumulative(mass, top);
}

static float density(const struct sampler *p, const struct outgoing *o, const float wi[3], float squared)
{
	float n = direction_normaliser(squared), ix = wi[0] * n, iy = wi[1] * n, iz = wi[2] * n;
	float hx = ix + o->x, hy = iy + o->y, hz = iz + o->z, ring = hx * hx + hy * hy, length2 = ring + hz * hz, length = sqrtf(length2);
	float along = hx * o->ex + hy * o->ey, across = fabsf(hy * o->ex - hx * o->ey);
	/* sin^2(theta_h / 2) = sin^2 theta_h / (2 (1 + cos theta_h)), without cancellation */
	float s = 0.5f * ring / (length2 + length * hz);
	float cos_phi = ring > 0 ? along / sqrtf(ring) : 1;
	float turns = quarter_turns(across, fabsf(along));
	turns = fabsf((along < 0 ? 2.0f : 0.0f) - turns);
	int phi = (int)(turns * (PHIS / 2)), bin = s_bin(s);
	phi = phi < PHIS ? phi : PHIS - 1;
	struct cut top = cut_at(p, horizon_s(o->sine, o->z, cos_phi));
	float lobe = (1 - o->share) * node_density(p, o->node, phi, bin, top) + o->share * node_density(p, o->node + 1, phi, bin, top);
	/* per unit of s and phi (both signs), per solid angle of h, then of wi: wo.h = |wi + wo| / 2 */
	lobe *= PHIS / (2 * PI_F) / 4 * p->s_per[bin] / length;
	return COSINE_SHARE / PI_F * iz + (1 - COSINE_SHARE) * lobe;
}

float sampler_pdf(const struct sampler *p, const float wi[3], const float wo[3])
{
	struct outgoing o;
	float squared = squared_length(wi);
	if (!direction_usable(wi[2], squared, wi[2], squared) || !outgoing_set(wo, &o))
		return 0;
	return density(p, &o, wi, squared);
}

/* ---- Drawing ---- */

static inline float unit_interval(float u)
{
	const float below_1 = 0x1.fffffep-1f;
	return u > 0 ? (u < below_1 ? u : below_1) : 0;
}

/*
 * The bin n of root * root with mass[n] <= x < mass[n + 1]; the last where there is none. Two rounds of comparisons that
 * do not wait for each other, and no branch: faster than halving, whose every step waits for a load.
 */
static inline int find(const float *mass, int root, float x)
{
	int coarse = 0, fine = 0;
	for (int k = 1; k < root; k++)
		coarse += mass[root * k] <= x;
	mass += root * coarse;
	for (int k = 1; k < root; k++)
		fine += mass[k] <= x;
	return root * coarse + fine;
}

static void draw_cosine(const float u[2], float wi[3])
{
	float radius = sqrtf(u[0]), sine, cosine, z = 1 - u[0];
	sine_cosine(2 * (u[1] < 0.5f ? 2 * u[1] : 2 * u[1] - 1), &sine, &cosine);
	wi[0] = radius * (u[1] < 0.5f ? cosine : -cosine);
	wi[1] = radius * (u[1] < 0.5f ? sine : -sine);
	wi[2] = sqrtf(z);
}

static void draw_lobe(const struct sampler *p, const struct outgoing *o, int node, const float u[2], float wi[3])
{
	const float *marginal = p->phi_mass[node];
	int phi = find(marginal, PHIS_ROOT, u[0]);
	float within = 2 * ((u[0] - marginal[phi]) / (marginal[phi + 1] - marginal[phi]));
	within = within < 2 ? within : 0x1.fffffep0f;
	float flip = (float)(int)within; /* the upper half of the bin's numbers: negative phi */
	within -= flip;
	float sin_phi, cos_phi;
	sine_cosine(((float)phi + within) * (2.0f / PHIS), &sin_phi, &cos_phi);
	sin_phi *= 1 - 2 * flip;

	const float *mass = p->s_mass[node][phi];
	float s_max = horizon_s(o->sine, o->z, cos_phi), target = u[1] * cumulative(mass, cut_at(p, s_max));
	int bin = find(mass, BINS_ROOT, target);
	float s = p->s_edge[bin] + (p->s_edge[bin + 1] - p->s_edge[bin]) * ((target - mass[bin]) / (mass[bin + 1] - mass[bin]));
	s = s < s_max ? s : s_max;

	float sine_h = 2 * sqrtf(s * (1 - s)), hz = 1 - 2 * s;
	float hx = sine_h * (cos_phi * o->ex - sin_phi * o->ey), hy = sine_h * (cos_phi * o->ey + sin_phi * o->ex);
	float twice = 2 * (hx * o->x + hy * o->y + hz * o->z);
	wi[0] = twice * hx - o->x;
	wi[1] = twice * hy - o->y;
	wi[2] = twice * hz - o->z;
}

float sampler_draw(const struct sampler *p, const float wo[3], const float u[3], float wi[3])
{
	struct outgoing o;
	if (!outgoing_set(wo, &o)) {
		wi[0] = wi[1] = wi[2] = 0;
		return 0;
	}
	const float choice = unit_interval(u[0]), rest[2] = {unit_interval(u[1]), unit_interval(u[2])};
	if (choice < COSINE_SHARE) {
		draw_cosine(rest, wi);
	} else {
		bool later = choice - COSINE_SHARE < o.share * (1 - COSINE_SHARE);
		draw_lobe(p, &o, o.node + later, rest, wi);
	}
	/* on the horizon, by rounding */
	wi[2] = wi[2] > 1e-7f ? wi[2] : 1e-7f;
	return density(p, &o, wi, squared_length(wi));
}

/* ---- Tables ---- */

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

bp_status sampler_build(const struct table *table, struct sampler **out, bp_error *error)
{
	struct sampler *p = malloc(sizeof *p);
	struct scratch *scratch = malloc(sizeof *scratch);
	if (!p || !scratch) {
		free(p);
		free(scratch);
		return error_memory(error, sizeof *p + sizeof *scratch);
	}
	for (int n = 0; n <= BINS; n++) {
		double edge = (double)n / BINS;
		p->s_edge[n] = (float)(0.5 * edge * edge * edge * edge);
	}
	for (int n = 0; n < BINS; n++)
		p->s_per[n] = 1 / (p->s_edge[n + 1] - p->s_edge[n]);
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

void sampler_free(struct sampler *sampler)
{
	free(sampler);
}

size_t sampler_bytes(const struct sampler *sampler)
{
	return sizeof *sampler;
}

void sampler_albedo(const struct table *table, float theta_o, float rgb[3])
{
	enum { TURNS = 128, STEPS = 512 }; /* phi_h, and s as a share of what is above the horizon, dense at the highlight */
	float in[6][STEPS], value[3][STEPS], weight[STEPS];
	double sum[3] = {0, 0, 0};

	rgb[0] = rgb[1] = rgb[2] = 0;
	if (!(theta_o >= 0 && theta_o < 1.5707963f))
		return;
	const float sine = sinf(theta_o), cosine = cosf(theta_o);
	for (int turn = 0; turn < TURNS; turn++) {
		const double phi = (turn + 0.5) / TURNS * 2 * 3.14159265358979324;
		const float cx = (float)cos(phi), cy = (float)sin(phi), top = horizon_s(sine, cosine, cx);
		for (int n = 0; n < STEPS; n++) {
			const float a = (float)n / STEPS, b = (float)(n + 1) / STEPS, q = ((float)n + 0.5f) / STEPS;
			const float s = top * (q * q) * (q * q), hz = 1 - 2 * s, radius = 2 * sqrtf(s * (1 - s)), hx = radius * cx;
			const float dot = hx * sine + hz * cosine, z = 2 * dot * hz - cosine;
			in[0][n] = 2 * dot * hx - sine;
			in[1][n] = 2 * dot * radius * cy;
			in[2][n] = z;
			in[3][n] = sine;
			in[4][n] = 0;
			in[5][n] = cosine;
			/* f cos theta_i 4 (wo.h) 2 ds dphi; b^4 - a^4 without cancellation */
			weight[n] = z > 0 ? z * 4 * dot * 2 * top * ((b - a) * (b + a) * (b * b + a * a)) : 0;
		}
		table_evaluate_batch(table, STEPS, (const float *const[]){in[0], in[1], in[2]}, (const float *const[]){in[3], in[4], in[5]},
		                     (float *const[]){value[0], value[1], value[2]});
		for (int c = 0; c < 3; c++)
			for (int n = 0; n < STEPS; n++)
				sum[c] += (double)value[c][n] * (double)weight[n];
	}
	for (int c = 0; c < 3; c++)
		rgb[c] = (float)(sum[c] * 2 * 3.14159265358979324 / TURNS);
}
