/*
 * sphere.h: a unit sphere under fixed lights, seen along -z, orthographic.
 *
 * Pixel (x, y) of a size x size image, y = 0 on top, sees the normal (u, v, sqrt(1 - u^2 - v^2)) with
 * u = 2 (x + 1/2)/size - 1, v = 1 - 2 (y + 1/2)/size; it is covered when u^2 + v^2 < 0.99. Its radiance is
 *
 *     sum over lights of  f(theta_h, theta_d, phi_d) cos(theta_i) weight
 *
 * over lights with cos(theta_i) > 1e-3, without shadows or interreflection; f is looked up as lookup.h says.
 * A *plan* holds the place of every pixel and light, made once and used for every material.
 */
#ifndef RENDER_SPHERE_H
#define RENDER_SPHERE_H

#include "lights.h"
#include "lookup.h"

enum { SPHERE_SIZE = 160, SPHERE_SIZE_MAX = 4096 };

/* A linear image. Values are multiples of `unit`; uncovered pixels are 0. */
struct sphere_image {
	uint32_t size;
	double unit;
	float *rgb;       /* 3 * size * size, interleaved, top row first */
	uint8_t *covered; /* size * size, 1 or 0 */
	size_t covered_count;
};

/* The normal that a pixel sees; false when it is not covered. */
bool sphere_normal(uint32_t size, uint32_t x, uint32_t y, double normal[3]);
/* The direction to a light from the point of the sphere whose normal is n; returns its irradiance there at normal incidence. */
double sphere_light(const struct light *light, const double n[3], double to[3]);
#define SPHERE_COSINE_ABOVE 1e-3 /* lights that come in lower than this count nothing */

/* All 0, in the unit 1, with the pixels marked that are covered. */
bp_status sphere_image_alloc(uint32_t size, struct sphere_image *out, bp_error *error);
void sphere_image_free(struct sphere_image *image);

struct sphere_plan;

/*
 * Plans rows row_first .. row_first + row_count - 1 of an image for tables of `dims`. Takes 16 bytes per covered
 * pixel and light that reaches it (env at 160 pixels: about 70 MB). BP_ERROR_ARGUMENT: size not in
 * 1 .. SPHERE_SIZE_MAX, rows outside the image.
 */
bp_status sphere_plan_make(enum lighting lighting, uint32_t size, uint32_t row_first, uint32_t row_count,
                           struct lattice_dims dims, struct sphere_plan **out, bp_error *error);
void sphere_plan_free(struct sphere_plan *plan); /* NULL is allowed */

/*
 * Fills the plan's rows of one image per table; images[t] was allocated with the plan's size and takes over the
 * table's unit. All tables have the plan's dims.
 */
void sphere_plan_render(const struct sphere_plan *plan, const struct lookup_table *const *tables, int count,
                        struct sphere_image *const *images);

/* A whole image without a plan of one's own: works through bands of rows in bounded memory (about 100 MB). */
bp_status sphere_render(enum lighting lighting, const struct lookup_table *table, struct sphere_image *image, bp_error *error);

#endif
