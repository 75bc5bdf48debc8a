#include "deviation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "render/metrics.h"

enum { SIZE = 96, LIGHTINGS = 2, ALBEDOS = 3, STEPS = 128, TURNS = 48 };
static const enum lighting LIT_BY[LIGHTINGS] = {LIGHTING_POINT, LIGHTING_KEY};
static const double ALBEDO_AT[ALBEDOS] = {0.1, 0.8, 1.3}; /* radians */

static const double PSNR_ENOUGH = 52, ALBEDO_ENOUGH = 0.005;

bool deviation_suffices(const struct deviation *deviation)
{
	return deviation->psnr >= PSNR_ENOUGH && deviation->albedo <= ALBEDO_ENOUGH;
}

/* One pixel under one light: pair `n` of the list, and what its f is multiplied by; f cos theta_o by `weight` alone. */
struct shaded {
	uint32_t pixel;
	float cosine, weight;
};

struct deviation_reference {
	struct pairs pairs[LIGHTINGS]; /* wi, wo and, after evaluation, f */
	struct shaded *shaded[LIGHTINGS];
	struct sphere_image image[LIGHTINGS];
	struct pairs half[ALBEDOS]; /* of one quadrature each */
	float *weight[ALBEDOS];     /* f cos theta_o is multiplied by */
	double albedo[ALBEDOS][3];
};

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/*
 * The pairs of one pixel: in a frame with the normal n, the viewer, who looks along -z, in its xz plane. Returns how many there
 * are; with pairs NULL it only counts.
 */
static size_t pixel_pairs(const double n[3], const struct light *lights, int light_count, uint32_t pixel, size_t first,
                          struct pairs *pairs, struct shaded *shaded)
{
	const double across = hypot(n[0], n[1]), x = across > 0 ? n[0] / across : 1, y = across > 0 ? n[1] / across : 0;
	/* tangents: one in the plane of n and z, the other level */
	const double tangent[3] = {-x * n[2], -y * n[2], across}, level[3] = {y, -x, 0}, view[3] = {across, 0, n[2]};
	size_t count = 0;
	for (int k = 0; k < light_count; k++) {
		double to[3];
		const double weight = sphere_light(&lights[k], n, to), cosine = dot(to, n);
		if (cosine <= SPHERE_COSINE_ABOVE)
			continue;
		if (pairs) {
			pairs_set(pairs, first + count, view, (const double[3]){dot(to, tangent), dot(to, level), cosine});
			shaded[first + count] = (struct shaded){pixel, (float)cosine, (float)weight};
		}
		count++;
	}
	return count;
}

/* All pixels. With pairs NULL it only counts. */
static size_t image_pairs(enum lighting lighting, struct pairs *pairs, struct shaded *shaded)
{
	struct light lights[LIGHTS_MAX];
	const int light_count = lights_make(lighting, lights);
	size_t count = 0;
	double n[3];
	for (uint32_t pixel = 0; pixel < SIZE * SIZE; pixel++)
		if (sphere_normal(SIZE, pixel % SIZE, pixel / SIZE, n))
			count += pixel_pairs(n, lights, light_count, pixel, count, pairs, shaded);
	return count;
}

static bp_status lighting_make(int n, const struct reflectance *reflectance, struct deviation_reference *reference,
                               bp_error *error)
{
	struct sphere_image *image = &reference->image[n];
	bp_status status = sphere_image_alloc(SIZE, image, error);
	if (status)
		return status;
	const size_t count = image_pairs(LIT_BY[n], NULL, NULL);
	struct pairs *pairs = &reference->pairs[n];
	struct shaded *shaded = reference->shaded[n] = malloc(count * sizeof *shaded);
	if (!pairs_alloc(count, pairs) || !shaded)
		return error_memory(error, count * sizeof *shaded);
	image_pairs(LIT_BY[n], pairs, shaded);
	pairs_evaluate(pairs, reflectance);
	for (size_t k = 0; k < count; k++)
		for (int c = 0; c < 3; c++)
			image->rgb[3 * shaded[k].pixel + (uint32_t)c] += pairs->rgb[c][k] * shaded[k].cosine * shaded[k].weight;
	return BP_OK;
}

/*
 * The albedo at one angle: midpoints in (u, v) of the half vector, which the lattice's cells are dense in as well. With m at u, v
 * a solid angle dm is 2 pi^2 u sin theta du dv, and that of w_o 4 <w_i, m> times it. Pairs beyond the horizon weigh 0.
 */
static bp_status albedo_make(int n, const struct reflectance *reflectance, struct deviation_reference *reference, bp_error *error)
{
	struct pairs *pairs = &reference->half[n];
	float *weight = reference->weight[n] = malloc(STEPS * TURNS * sizeof *weight);
	double wi[3], m[3], wo[3];
	if (!pairs_alloc(STEPS * TURNS, pairs) || !weight)
		return error_memory(error, STEPS * TURNS * sizeof *weight);
	direction_at(ALBEDO_AT[n], 0, wi);
	for (uint32_t k = 0; k < STEPS * TURNS; k++) {
		const double u = (k % STEPS + 0.5) / STEPS, theta = u * u * M_PI_2;
		direction_at(theta, (k / STEPS + 0.5) / TURNS * 2 * M_PI, m);
		const double facing = dot(wi, m), solid = 2 * M_PI * M_PI * u * sin(theta) / (STEPS * TURNS);
		for (int axis = 0; axis < 3; axis++)
			wo[axis] = 2 * facing * m[axis] - wi[axis];
		pairs_set(pairs, k, wi, wo);
		weight[k] = wo[2] > 0 ? (float)(4 * facing * solid) : 0;
	}
	pairs_evaluate(pairs, reflectance);
	for (size_t k = 0; k < STEPS * TURNS; k++)
		for (int c = 0; c < 3; c++)
			reference->albedo[n][c] += weight[k] > 0 ? (double)pairs->rgb[c][k] * pairs->wo[2][k] * weight[k] : 0;
	return BP_OK;
}

bp_status deviation_reference_make(const struct reflectance *reflectance, struct deviation_reference **out, bp_error *error)
{
	struct deviation_reference *reference = calloc(1, sizeof *reference);
	bp_status status = reference ? BP_OK : error_memory(error, sizeof *reference);
	for (int n = 0; !status && n < LIGHTINGS; n++)
		status = lighting_make(n, reflectance, reference, error);
	for (int n = 0; !status && n < ALBEDOS; n++)
		status = albedo_make(n, reflectance, reference, error);
	if (status)
		deviation_reference_free(reference);
	else
		*out = reference;
	return status;
}

void deviation_reference_free(struct deviation_reference *reference)
{
	for (int n = 0; reference && n < LIGHTINGS; n++) {
		pairs_free(&reference->pairs[n]);
		free(reference->shaded[n]);
		sphere_image_free(&reference->image[n]);
	}
	for (int n = 0; reference && n < ALBEDOS; n++) {
		pairs_free(&reference->half[n]);
		free(reference->weight[n]);
	}
	free(reference);
}

static void pair_evaluate(const struct pairs *pairs, size_t n, exported_evaluate *evaluate, const void *exported, double value[3])
{
	const float wi[3] = {pairs->wi[0][n], pairs->wi[1][n], pairs->wi[2][n]};
	const float wo[3] = {pairs->wo[0][n], pairs->wo[1][n], pairs->wo[2][n]};
	evaluate(exported, wi, wo, value);
}

static double albedo_deviation(int n, const struct deviation_reference *reference, exported_evaluate *evaluate,
                               const void *exported)
{
	const double *wanted = reference->albedo[n];
	double sum[3] = {0}, off = 0;
	for (size_t k = 0; k < reference->half[n].count; k++) {
		double value[3];
		if (reference->weight[n][k] <= 0)
			continue;
		pair_evaluate(&reference->half[n], k, evaluate, exported, value);
		for (int c = 0; c < 3; c++)
			sum[c] += value[c] * reference->weight[n][k];
	}
	for (int c = 0; c < 3; c++)
		off = fmax(off, wanted[c] > 0 ? fabs(sum[c] / wanted[c] - 1) : 0);
	return off;
}

static bp_status sphere_deviation(int n, const struct deviation_reference *reference, exported_evaluate *evaluate,
                                  const void *exported, struct sphere_image *image, double *psnr, bp_error *error)
{
	const struct shaded *shaded = reference->shaded[n];
	struct psnr figure;
	memset(image->rgb, 0, 3 * sizeof(float) * SIZE * SIZE);
	for (size_t k = 0; k < reference->pairs[n].count; k++) {
		double value[3];
		pair_evaluate(&reference->pairs[n], k, evaluate, exported, value);
		for (int c = 0; c < 3; c++)
			image->rgb[3 * shaded[k].pixel + (uint32_t)c] += (float)value[c] * shaded[k].weight;
	}
	const bp_status status = metrics_psnr(&reference->image[n], image, &figure, error);
	*psnr = status ? 0 : figure.real;
	return status;
}

bp_status deviation_measure(const struct deviation_reference *reference, exported_evaluate *evaluate, const void *exported,
                            struct deviation *out, bp_error *error)
{
	struct sphere_image image;
	bp_status status = sphere_image_alloc(SIZE, &image, error);
	*out = (struct deviation){HUGE_VAL, 0};
	for (int n = 0; !status && n < LIGHTINGS; n++) {
		double psnr;
		status = sphere_deviation(n, reference, evaluate, exported, &image, &psnr, error);
		out->psnr = fmin(out->psnr, psnr);
	}
	for (int n = 0; !status && n < ALBEDOS; n++)
		out->albedo = fmax(out->albedo, albedo_deviation(n, reference, evaluate, exported));
	sphere_image_free(&image);
	return status;
}
