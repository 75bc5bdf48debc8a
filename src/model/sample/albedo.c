#include "albedo.h"

#include <math.h>
#include <string.h>

#include "environment.h"
#include "error.h"
#include "memory.h"
#include "model/math/fast_math.h"
#include "horizon_s.h"

void albedo_integrate(const struct table *table, float theta_o, float rgb[3])
{
	enum { TURNS = 128, STEPS = 512 }; /* phi_h, and s as a share of what is above the horizon, dense at the highlight */
	float in[6][STEPS], value[3][STEPS], weight[STEPS];
	double sum[3] = {0, 0, 0};

	rgb[0] = rgb[1] = rgb[2] = 0;
	if (!(theta_o >= 0 && theta_o < 1.5707963f))
		return;
	const float sine = sinf(theta_o), cosine = cosf(theta_o);
	for (int turn = 0; turn < TURNS; turn++) {
		/* five times as dense about phi_h = 0, where wi = wo lies: a retroreflector's peak is narrower than even steps */
		const double even = (turn + 0.5) / TURNS * 2 * 3.14159265358979324, phi = even - 0.8 * sin(even),
					 per = 1 - 0.8 * cos(even);
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
		table_evaluate_batch(table, STEPS, (const float *const[]){in[0], in[1], in[2]},
		                     (const float *const[]){in[3], in[4], in[5]}, (float *const[]){value[0], value[1], value[2]});
		for (int c = 0; c < 3; c++) {
			double part = 0;
			for (int n = 0; n < STEPS; n++)
				part += (double)value[c][n] * (double)weight[n];
			sum[c] += part * per;
		}
	}
	for (int c = 0; c < 3; c++)
		rgb[c] = (float)(sum[c] * 2 * 3.14159265358979324 / TURNS);
}

/* ---- Kept angles ---- */

enum { ANGLES = 128 };
#define HALF_PI 1.57079632679489662

/*
 * Threads that find an angle missing integrate it each, and store the same bits; the values are whole before `known` says so.
 */
struct albedo_cache {
	uint32_t known[ANGLES];
	uint32_t bits[ANGLES][3]; /* of floats */
};

/* x in [0, 1] stands for theta = sin^2(x pi/2) pi/2, dense at both ends; the last angle is a little above the horizon. */
static float angle_theta(int n)
{
	double cosine = cos((double)n / (ANGLES - 1) * HALF_PI);
	return (float)((1 - fmax(cosine * cosine, 1e-5)) * HALF_PI);
}

static void angle_get(struct albedo_cache *cache, const struct table *table, int n, double rgb[3])
{
	float value[3];
	if (__atomic_load_n(&cache->known[n], __ATOMIC_ACQUIRE)) {
		for (int c = 0; c < 3; c++)
			value[c] = float_of_bits(__atomic_load_n(&cache->bits[n][c], __ATOMIC_RELAXED));
	} else {
		fenv_t before; /* what is kept is everyone's */
		environment_enter(&before);
		albedo_integrate(table, angle_theta(n), value);
		environment_leave(&before);
		for (int c = 0; c < 3; c++)
			__atomic_store_n(&cache->bits[n][c], bits_of_float(value[c]), __ATOMIC_RELAXED);
		__atomic_store_n(&cache->known[n], 1, __ATOMIC_RELEASE);
	}
	for (int c = 0; c < 3; c++)
		rgb[c] = (double)value[c];
}

bp_status albedo_cache_make(struct albedo_cache **out, bp_error *error)
{
	struct albedo_cache *cache = memory_alloc_kept(sizeof *cache);
	if (!cache)
		return error_memory(error, sizeof *cache);
	memset(cache, 0, sizeof *cache);
	*out = cache;
	return BP_OK;
}

void albedo_cache_free(struct albedo_cache *cache) { memory_free_kept(cache); }

size_t albedo_cache_bytes(void) { return sizeof(struct albedo_cache); }

void albedo_cached(struct albedo_cache *cache, const struct table *table, float theta_o, float rgb[3])
{
	rgb[0] = rgb[1] = rgb[2] = 0;
	if (!(theta_o >= 0 && theta_o < 1.5707963f))
		return;
	const double at = asin(sqrt(fmin(1, (double)theta_o / HALF_PI))) / HALF_PI * (ANGLES - 1);
	int first = (int)at - 1;
	first = first < 0 ? 0 : first > ANGLES - 4 ? ANGLES - 4 : first;
	double sum[3] = {0, 0, 0};
	for (int n = 0; n < 4; n++) { /* Lagrange's weights at 0, 1, 2, 3 */
		double weight = 1, x = at - first, value[3];
		for (int m = 0; m < 4; m++)
			weight *= m == n ? 1 : (x - m) / (n - m);
		angle_get(cache, table, first + n, value);
		for (int c = 0; c < 3; c++)
			sum[c] += weight * value[c];
	}
	for (int c = 0; c < 3; c++)
		rgb[c] = sum[c] > 0 ? (float)sum[c] : 0;
}
