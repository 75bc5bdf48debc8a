#include "importance.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "model/math/select.h"
#include "paper_kernels.h"

struct importance {
	struct lattice_dims dims;
	struct importance_place *place; /* theta_h x theta_d */
	float *cos_phi;                 /* at the cells' centres */
	double chance[];                /* running sums of area over the places; behind them the arrays above */
};

static void places_fill(struct importance *m)
{
	const struct lattice_dims d = m->dims;
	struct lattice_cosines c;
	double sum = 0;

	lattice_centres(d, &c);
	for (uint32_t i = 0; i < d.theta_h; i++) {
		const double width = (2.0 * i + 1) / d.theta_h / d.theta_h;
		for (uint32_t j = 0; j < d.theta_d; j++) {
			struct importance_place *place = &m->place[i * d.theta_d + j];
			place->even = (float)(c.cos_d[j] * c.cos_h[i]);
			place->odd = (float)(c.sin_d[j] * c.sin_h[i]);
			place->area = (float)(width * 1.5707963267948966 * c.sin_h[i] * c.sin_d[j] * c.cos_d[j]);
			place->relative = 0.01f / (float)d.theta_h;
			sum += (double)place->area;
			m->chance[i * d.theta_d + j] = sum;
		}
	}
	for (uint32_t k = 0; k < d.phi_d; k++)
		m->cos_phi[k] = (float)c.cos_p[k];
}

bp_status importance_create(struct lattice_dims dims, struct importance **out, bp_error *error)
{
	const size_t places = (size_t)dims.theta_h * dims.theta_d;
	const size_t bytes =
		sizeof(struct importance) + places * (sizeof(double) + sizeof(struct importance_place)) + dims.phi_d * sizeof(float);
	struct importance *m = malloc(bytes);

	if (!m)
		return error_memory(error, bytes);
	m->dims = dims;
	m->place = (struct importance_place *)(m->chance + places);
	m->cos_phi = (float *)(m->place + places);
	places_fill(m);
	*out = m;
	return BP_OK;
}

/* ---- the unit ---- */

enum { PIXELS = 1000, LIGHTS = 29 };

/* 2^0 / 2^53 .. of Knuth's 64-bit sequence: the same everywhere. */
static double draw(uint64_t *state)
{
	*state = *state * 6364136223846793005u + 1442695040888963407u;
	return (double)(*state >> 11) * 0x1p-53;
}

static double cell_mean(const struct lattice *lattice, size_t cell, double scale)
{
	if (!lattice->valid[cell])
		return 0;
	return (lattice->rgb[0][cell] * scale + lattice->rgb[1][cell] * scale + lattice->rgb[2][cell] * scale) / 3;
}

/*
 * The brightness of one light in one pixel: the mean of the channels' values times cos theta_i, or 0 where either direction is
 * below the horizon; of a cell and its mirror image, so that a mirrored table has the same unit.
 */
static double light_drawn(const struct importance *m, const struct lattice *lattice, double scale, uint64_t *state)
{
	const struct lattice_dims d = m->dims;
	const uint32_t places = d.theta_h * d.theta_d;
	const double at = draw(state) * m->chance[places - 1];
	uint32_t low = 0, high = places - 1;
	const uint32_t k = (uint32_t)(draw(state) * d.phi_d);

	while (low < high) { /* the first place with chance > at */
		const uint32_t middle = (low + high) / 2;
		if (m->chance[middle] > at)
			high = middle;
		else
			low = middle + 1;
	}
	const size_t row = (size_t)low * d.phi_d;
	const double turn = (double)(m->place[low].odd * m->cos_phi[k]), i = (double)m->place[low].even - turn,
				 o = (double)m->place[low].even + turn;
	const bool seen = draw(state) < i + o;
	if (i <= 0 || o <= 0 || !seen)
		return 0;
	return (cell_mean(lattice, row + k, scale) * i + cell_mean(lattice, row + d.phi_d - 1 - k, scale) * o) / 2;
}

double importance_unit(const struct importance *m, const struct lattice *lattice)
{
	static const double STRONG[] = {3, 1.5, 1.5, 1, 0.6};
	enum { STRONG_COUNT = sizeof STRONG / sizeof *STRONG };
	double pixel[PIXELS], mean = 0, brightness;
	uint64_t state = 1;
	int exponent;

	frexp(lattice_largest(lattice), &exponent);
	const double scale = ldexp(1, exponent < -1000 ? 1000 : -exponent); /* the largest becomes about 1: no sum overflows */
	for (int n = 0; n < PIXELS; n++) {
		pixel[n] = 0;
		for (int l = 0; l < LIGHTS; l++)
			pixel[n] += (l < STRONG_COUNT ? STRONG[l] : 0.15) * light_drawn(m, lattice, scale, &state);
		mean += pixel[n] / PIXELS;
	}
	brightness = select_kth(pixel, PIXELS, PIXELS * 9 / 10);
	if (!(brightness > 1e-4 * mean))
		brightness = mean > 0 ? mean : 1;
	return fmax(ldexp(brightness, exponent < -1000 ? -1000 : exponent), DBL_MIN);
}

/* ---- weights ---- */

void importance_weigh(const struct importance *m, const struct lattice *lattice, int channel, double unit, float *value,
                      float *weight)
{
	const struct paper_kernels *kernels = paper_kernels_get();
	const struct lattice_dims d = m->dims;
	int exponent;
	const double mantissa = frexp(unit, &exponent), factor[2] = {ldexp(1, -exponent), 1 / mantissa};

	for (uint32_t row = 0; row < d.theta_h * d.theta_d; row++) {
		const size_t at = (size_t)row * d.phi_d;
		kernels->normalise_row(lattice->rgb[channel] + at, lattice->valid + at, factor, d.phi_d, value + at);
		kernels->importance_row(&m->place[row], m->cos_phi, value + at, lattice->valid + at, d.phi_d, weight + at);
	}
}

void importance_shown(const struct importance *m, const struct lattice *lattice, float *shown)
{
	const uint32_t n = m->dims.phi_d;

	for (uint32_t row = 0; row < m->dims.theta_h * m->dims.theta_d; row++)
		for (uint32_t k = 0; k < n; k++) {
			const size_t at = (size_t)row * n + k;
			const float turn = m->place[row].odd * m->cos_phi[k], least = m->place[row].even - (turn > 0 ? turn : -turn);
			shown[at] = !lattice->valid[at] ? 0 : least > 0 ? (least < 0.24f ? 0.05f + 4 * least : 1) : 0.01f;
		}
}
