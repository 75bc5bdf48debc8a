#include "sphere_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "render/metrics.h"

enum { SIZE = 96, LIGHTINGS = 2 };
static const enum lighting LIT_BY[LIGHTINGS] = {LIGHTING_POINT, LIGHTING_KEY};

/* One pixel under one light: pair `n` of the list, and what its f is multiplied by; f cos theta_o by `weight` alone. */
struct shaded {
	uint32_t pixel;
	float cosine, weight;
};

struct sphere_reference {
	struct pairs pairs[LIGHTINGS]; /* wi, wo and, after evaluation, f */
	struct shaded *shaded[LIGHTINGS];
	struct sphere_image image[LIGHTINGS];
};

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* The direction to a light from the point of the unit sphere whose normal is n; returns its irradiance at normal incidence. */
static double light_from(const struct light *light, const double n[3], double to[3])
{
	if (!light->is_point) {
		memcpy(to, light->at, sizeof light->at);
		return light->weight;
	}
	for (int axis = 0; axis < 3; axis++)
		to[axis] = light->at[axis] - n[axis];
	const double square = dot(to, to);
	for (int axis = 0; axis < 3; axis++)
		to[axis] /= sqrt(square);
	return light->weight / square;
}

/*
 * The pairs of one pixel: in a frame with the normal n, the viewer, who looks along -z, in its xz plane. Returns how many there are;
 * with pairs NULL it only counts.
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
		const double weight = light_from(&lights[k], n, to), cosine = dot(to, n);
		if (cosine <= 1e-3)
			continue;
		if (pairs) {
			pairs_set(pairs, first + count, view, (const double[3]){dot(to, tangent), dot(to, level), cosine});
			shaded[first + count] = (struct shaded){pixel, (float)cosine, (float)weight};
		}
		count++;
	}
	return count;
}

/* All pixels; marks those that are covered. With pairs NULL it only counts. */
static size_t image_pairs(enum lighting lighting, struct sphere_image *image, struct pairs *pairs, struct shaded *shaded)
{
	struct light lights[LIGHTS_MAX];
	const int light_count = lights_make(lighting, lights);
	size_t count = 0;
	image->covered_count = 0;
	for (uint32_t pixel = 0; pixel < SIZE * SIZE; pixel++) {
		const double u = (pixel % SIZE + 0.5) / SIZE * 2 - 1, v = 1 - (pixel / SIZE + 0.5) / SIZE * 2, square = u * u + v * v;
		image->covered[pixel] = square < 0.99;
		if (!image->covered[pixel])
			continue;
		image->covered_count++;
		const double n[3] = {u, v, sqrt(1 - square)};
		count += pixel_pairs(n, lights, light_count, pixel, count, pairs, shaded);
	}
	return count;
}

static bp_status lighting_make(int n, const struct reflectance *reflectance, struct sphere_reference *reference, bp_error *error)
{
	struct sphere_image *image = &reference->image[n];
	bp_status status = sphere_image_alloc(SIZE, image, error);
	if (status)
		return status;
	image->unit = 1;
	memset(image->rgb, 0, 3 * sizeof(float) * SIZE * SIZE);
	const size_t count = image_pairs(LIT_BY[n], image, NULL, NULL);
	struct pairs *pairs = &reference->pairs[n];
	struct shaded *shaded = reference->shaded[n] = malloc(count * sizeof *shaded);
	if (!pairs_alloc(count, pairs) || !shaded)
		return error_memory(error, count * sizeof *shaded);
	image_pairs(LIT_BY[n], image, pairs, shaded);
	pairs_evaluate(pairs, reflectance);
	for (size_t k = 0; k < count; k++)
		for (int c = 0; c < 3; c++)
			image->rgb[3 * shaded[k].pixel + (uint32_t)c] += pairs->rgb[c][k] * shaded[k].cosine * shaded[k].weight;
	return BP_OK;
}

bp_status sphere_reference_make(const struct reflectance *reflectance, struct sphere_reference **out, bp_error *error)
{
	struct sphere_reference *reference = calloc(1, sizeof *reference);
	bp_status status = reference ? BP_OK : error_memory(error, sizeof *reference);
	for (int n = 0; !status && n < LIGHTINGS; n++)
		status = lighting_make(n, reflectance, reference, error);
	if (status)
		sphere_reference_free(reference);
	else
		*out = reference;
	return status;
}

void sphere_reference_free(struct sphere_reference *reference)
{
	for (int n = 0; reference && n < LIGHTINGS; n++) {
		pairs_free(&reference->pairs[n]);
		free(reference->shaded[n]);
		sphere_image_free(&reference->image[n]);
	}
	free(reference);
}

static void exported_draw(const struct pairs *pairs, const struct shaded *shaded, exported_evaluate *evaluate,
                          const void *exported, float *pixels)
{
	for (size_t k = 0; k < pairs->count; k++) {
		const float wi[3] = {pairs->wi[0][k], pairs->wi[1][k], pairs->wi[2][k]};
		const float wo[3] = {pairs->wo[0][k], pairs->wo[1][k], pairs->wo[2][k]};
		double value[3];
		evaluate(exported, wi, wo, value);
		for (int c = 0; c < 3; c++)
			pixels[3 * shaded[k].pixel + (uint32_t)c] += (float)value[c] * shaded[k].weight;
	}
}

bp_status sphere_error(const struct sphere_reference *reference, exported_evaluate *evaluate, const void *exported, double *psnr,
                       bp_error *error)
{
	struct sphere_image image;
	bp_status status = sphere_image_alloc(SIZE, &image, error);
	*psnr = HUGE_VAL;
	for (int n = 0; !status && n < LIGHTINGS; n++) {
		struct psnr figure;
		image.unit = 1;
		image.covered_count = reference->image[n].covered_count;
		memcpy(image.covered, reference->image[n].covered, SIZE * SIZE);
		memset(image.rgb, 0, 3 * sizeof(float) * SIZE * SIZE);
		exported_draw(&reference->pairs[n], reference->shaded[n], evaluate, exported, image.rgb);
		status = metrics_psnr(&reference->image[n], &image, &figure, error);
		if (!status)
			*psnr = fmin(*psnr, figure.real);
	}
	sphere_image_free(&image);
	return status;
}
