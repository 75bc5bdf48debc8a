#include "sphere.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"

static const double COVERED_BELOW = 0.99;
enum { BAND_PLACES = 6000000 };

/* Consecutive pixels under one light; their places follow in the same order. */
struct run {
	uint32_t pixel, count;
};

struct sphere_plan {
	uint32_t size, row_first, row_count;
	struct lattice_dims dims;
	struct run *runs;
	struct place *places;
	size_t run_count, place_count, place_capacity;
};

/*
 * The place of a normal n, a direction l to the light and the view v = (0, 0, 1), in Rusinkiewicz's coordinates.
 * With h = (l + v)/(2 cos theta_d), cos theta_d = sqrt((1 + l_z)/2):
 *
 *     cos theta_h = (n.l + n_z)/(2 cos theta_d)
 *     tan phi_d   = l.(n x h) / (l.(h cos theta_h - n)) = ((n_y l_x - n_x l_y)/cos theta_d) / (n_z - n.l)
 *
 * l_z > -1 holds wherever both n.l > 0 and n_z > 0.
 */
static struct place pixel_place(const struct angle_tables *angles, struct lattice_dims dims, const double n[3], const double l[3],
                                double cosine, double weight)
{
	double cos_d = sqrt(fmax(1e-24, 1 + l[2]) * 0.5), cos_h = (cosine + n[2]) / (2 * cos_d);
	return place_make(angles, dims, cos_h, cos_d, n[1] * l[0] - n[0] * l[1], (n[2] - cosine) * cos_d, cosine * weight);
}

bool sphere_normal(uint32_t size, uint32_t x, uint32_t y, double normal[3])
{
	double u = (x + 0.5) / size * 2 - 1, v = 1 - (y + 0.5) / size * 2, square = u * u + v * v;
	if (square >= COVERED_BELOW)
		return false;
	normal[0] = u;
	normal[1] = v;
	normal[2] = sqrt(1 - square);
	return true;
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double sphere_light(const struct light *light, const double n[3], double to[3])
{
	if (!light->is_point) {
		memcpy(to, light->at, sizeof light->at);
		return light->weight;
	}
	double d[3] = {light->at[0] - n[0], light->at[1] - n[1], light->at[2] - n[2]}, square = dot(d, d), scale = 1 / sqrt(square);
	for (int q = 0; q < 3; q++)
		to[q] = d[q] * scale;
	return light->weight / square;
}

static bool plan_grow(struct sphere_plan *plan)
{
	struct run *runs = memory_grown(plan->runs, plan->run_count, sizeof *runs);
	if (!runs)
		return false;
	plan->runs = runs;
	/* room for one whole row more */
	if (plan->place_count + plan->size > plan->place_capacity) {
		size_t capacity = plan->place_capacity + plan->place_capacity / 2 + plan->size + 4096;
		struct place *places = realloc(plan->places, capacity * sizeof *places);
		if (!places)
			return false;
		plan->places = places;
		plan->place_capacity = capacity;
	}
	return true;
}

/* Appends one row under one light. */
static bool plan_row(struct sphere_plan *plan, const struct angle_tables *angles, const struct light *light, uint32_t y)
{
	bool open = false;
	for (uint32_t x = 0; x < plan->size; x++) {
		double normal[3], to[3];
		bool lit = sphere_normal(plan->size, x, y, normal);
		double weight = lit ? sphere_light(light, normal, to) : 0, cosine = lit ? dot(normal, to) : 0;
		if (cosine <= SPHERE_COSINE_ABOVE) {
			open = false;
			continue;
		}
		if (!open) {
			if (!plan_grow(plan))
				return false;
			plan->runs[plan->run_count++] = (struct run){.pixel = x + plan->size * y};
			open = true;
		}
		plan->places[plan->place_count++] = pixel_place(angles, plan->dims, normal, to, cosine, weight);
		plan->runs[plan->run_count - 1].count++;
	}
	return true;
}

static bp_status size_check(uint32_t size, bool rows_inside, bp_error *error)
{
	if (size >= 1 && size <= SPHERE_SIZE_MAX && rows_inside)
		return BP_OK;
	return error_argument(error, "an image of %u pixels: the size must be 1 to %d", size, SPHERE_SIZE_MAX);
}

bp_status sphere_plan_make(enum lighting lighting, uint32_t size, uint32_t row_first, uint32_t row_count,
                           struct lattice_dims dims, struct sphere_plan **out, bp_error *error)
{
	if (size_check(size, row_first <= size && row_count <= size - row_first, error))
		return BP_ERROR_ARGUMENT;
	struct light lights[LIGHTS_MAX];
	int light_count = lights_make(lighting, lights);
	struct sphere_plan *plan = calloc(1, sizeof *plan);
	struct angle_tables *angles = angle_tables_make();
	bool ok = plan && angles;
	if (ok)
		*plan = (struct sphere_plan){.size = size, .row_first = row_first, .row_count = row_count, .dims = dims};
	/* light by light: neighbouring pixels under one light read neighbouring cells */
	for (int n = 0; ok && n < light_count; n++)
		for (uint32_t y = row_first; ok && y < row_first + row_count; y++)
			ok = plan_row(plan, angles, &lights[n], y);
	free(angles);
	if (!ok) {
		size_t wanted = plan ? plan->place_capacity * sizeof *plan->places : sizeof *plan;
		sphere_plan_free(plan);
		return error_memory(error, wanted);
	}
	/* the plan stays for long: give back what growing has left over */
	struct place *trimmed = realloc(plan->places, (plan->place_count + 1) * sizeof *trimmed);
	plan->places = trimmed ? trimmed : plan->places;
	*out = plan;
	return BP_OK;
}

void sphere_plan_free(struct sphere_plan *plan)
{
	if (plan) {
		free(plan->runs);
		free(plan->places);
		free(plan);
	}
}

void sphere_plan_render(const struct sphere_plan *plan, const struct lookup_table *const *tables, int count,
                        struct sphere_image *const *images)
{
	const size_t first = (size_t)plan->row_first * plan->size, pixels = (size_t)plan->row_count * plan->size;
	for (int t = 0; t < count; t++) {
		images[t]->unit = tables[t]->unit;
		memset(images[t]->rgb + 3 * first, 0, 3 * pixels * sizeof(float));
	}
	const struct place *place = plan->places;
	for (size_t r = 0; r < plan->run_count; r++) {
		size_t pixel = plan->runs[r].pixel;
		for (uint32_t n = 0; n < plan->runs[r].count; n++, place++, pixel++)
			for (int t = 0; t < count; t++) {
				float4 value = place_look_up(place, tables[t]);
				float *out = images[t]->rgb + 3 * pixel;
				out[0] += value[0];
				out[1] += value[1];
				out[2] += value[2];
			}
	}
}

bp_status sphere_render(enum lighting lighting, const struct lookup_table *table, struct sphere_image *image, bp_error *error)
{
	struct light lights[LIGHTS_MAX];
	uint32_t size = image->size, light_count = (uint32_t)lights_make(lighting, lights);
	uint32_t rows = BAND_PLACES / (size * light_count);
	rows = rows < 1 ? 1 : rows;
	for (uint32_t y = 0; y < size; y += rows) {
		struct sphere_plan *plan;
		bp_status status = sphere_plan_make(lighting, size, y, rows < size - y ? rows : size - y, table->dims, &plan, error);
		if (status != BP_OK)
			return status;
		sphere_plan_render(plan, &table, 1, &image);
		sphere_plan_free(plan);
	}
	return BP_OK;
}

bp_status sphere_image_alloc(uint32_t size, struct sphere_image *out, bp_error *error)
{
	if (size_check(size, true, error))
		return BP_ERROR_ARGUMENT;
	struct sphere_image image = {.size = size, .unit = 1};
	size_t pixels = (size_t)size * size;
	image.rgb = calloc(3 * pixels, sizeof *image.rgb);
	image.covered = calloc(pixels, 1);
	if (!image.rgb || !image.covered) {
		sphere_image_free(&image);
		return error_memory(error, 13 * pixels);
	}
	double normal[3];
	for (uint32_t y = 0; y < size; y++)
		for (uint32_t x = 0; x < size; x++)
			image.covered_count += image.covered[x + (size_t)size * y] = sphere_normal(size, x, y, normal);
	*out = image;
	return BP_OK;
}

void sphere_image_free(struct sphere_image *image)
{
	free(image->rgb);
	free(image->covered);
	*image = (struct sphere_image){0};
}
