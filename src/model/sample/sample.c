#include "sample.h"

#include "sampler.h"

/* sin and cos of t quarter turns, t in [0, 2]; absolute error below 2e-7. Chebyshev fits about t = 1. */
static inline void sine_cosine(float t, float *sine, float *cosine)
{
	float x = t - 1, q = x * x;
	*cosine = -x * ((((0.000151671704f * q - 0.00467414384f) * q + 0.0796899183f) * q - 0.64596376f) * q + 1.57079632f);
	*sine = ((((-2.38241524e-05f * q + 0.000917722924f) * q - 0.0208626867f) * q + 0.253669322f) * q - 1.23370053f) * q + 1;
}

/* wo normalised, the sine of its polar angle, its azimuth as a unit vector ((1, 0) at the pole), its place between two nodes. */
struct outgoing {
	float x, y, z, sine, ex, ey;
	int node;    /* this one and the next */
	float share; /* of the next */
};

static inline float squared_length(const float w[3]) { return w[0] * w[0] + w[1] * w[1] + w[2] * w[2]; }

/*
 * The least cosine that is told apart, of 89.977 degrees: nearer to grazing the half-angle of wi and wo hangs on the rounding of
 * their components, and what is drawn for 89.977 degrees serves as well.
 */
#define GRAZING 4e-4f

static inline bool outgoing_set(const float wo[3], struct outgoing *o)
{
	float squared = squared_length(wo);
	if (!direction_usable(wo[2], squared, wo[2], squared))
		return false;
	float n = direction_normaliser(squared);
	o->x = wo[0] * n;
	o->y = wo[1] * n;
	o->z = wo[2] * n > GRAZING ? wo[2] * n : GRAZING;
	const float sine2 = o->x * o->x + o->y * o->y;
	o->sine = sqrtf(sine2);
	bool pole = !(o->sine > 0);
	float per = 1 / (pole ? 1 : o->sine);
	o->ex = pole ? 1 : o->x * per;
	o->ey = o->y * per;
	float at = node_coordinate(sine2, o->z * o->z);
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
	int n = s_bin(p, s);
	float t = (s - p->s_edge[n]) * p->s_per[n];
	t = t > 0 ? t : 0;
	return (struct cut){n, t < 1 ? t : 1};
}

/* The cumulative conditional there. */
static inline float cumulative(const float *mass, struct cut cut)
{
	return mass[cut.bin] + (mass[cut.bin + 1] - mass[cut.bin]) * cut.share;
}

/* Density over (s, |phi| in units of bins) at one node, before it is divided by what is above the horizon. */
static inline float node_density(const struct sampler *p, int node, int phi, int bin)
{
	const float *marginal = p->phi_mass[node], *mass = p->s_mass[node][phi];
	return (marginal[phi + 1] - marginal[phi]) * (mass[bin + 1] - mass[bin]);
}

static float density(const struct sampler *p, const struct outgoing *o, const float wi[3], float squared)
{
	float n = direction_normaliser(squared), ix = wi[0] * n, iy = wi[1] * n, iz = wi[2] * n;
	float hx = ix + o->x, hy = iy + o->y, hz = iz + o->z, ring = hx * hx + hy * hy, length2 = ring + hz * hz,
		  length = sqrtf(length2);
	float along = hx * o->ex + hy * o->ey, across = hy * o->ex - hx * o->ey;
	/* sin^2(theta_h / 2) = sin^2 theta_h / (2 (1 + cos theta_h)), without cancellation */
	float s = 0.5f * ring / (length2 + length * hz);
	float cos_phi = ring > 0 ? along / sqrtf(ring) : 1;
	/* |phi_h|, in quarter turns: 2 less where along < 0 */
	float turns =
		fabsf(horizon_choice(0 - (bits_of_float(along) >> 31), 2, 0) - turns_of_squares(across * across, along * along));
	int phi = (int)(turns * (PHIS / 2)), bin = s_bin(p, s);
	phi = phi < PHIS ? phi : PHIS - 1;
	struct cut top = cut_at(p, horizon_s(o->sine, o->z, cos_phi));
	float above = cumulative(p->s_mass[o->node][phi], top), above_next = cumulative(p->s_mass[o->node + 1][phi], top);
	float lobe = (1 - o->share) * node_density(p, o->node, phi, bin) * above_next +
	             o->share * node_density(p, o->node + 1, phi, bin) * above;
	/* per unit of s and phi (both signs), per solid angle of h, then of wi: wo.h = |wi + wo| / 2 */
	lobe *= PHIS / (2 * PI_F) / 4 * p->s_per[bin] / (above * above_next * length);
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
