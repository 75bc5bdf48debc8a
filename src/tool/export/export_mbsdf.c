/*
 * A table of f over (theta_in, theta_out, phi), the azimuth between both, equally spaced: theta in [0, pi/2), phi in [0, pi].
 * A value stands for its cell's centre, as the texture look-up of the MDL SDK has it, which is linear between centres and keeps
 * the value beyond the outer ones; and it takes the mean of both orders of the directions. Isotropic materials that are not their
 * own mirror image become the mean of both.
 */
#include "export.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"

/* Cells of theta; of phi there are twice as many. */
static const uint32_t SIZES[] = {16, 20, 24, 30, 36, 45, 60, 72, 90, 120, 150, 180};
enum { SIZE_COUNT = sizeof SIZES / sizeof *SIZES, HEADER_BYTES_MAX = 2 * BP_NAME_BYTES_MAX + 64, TYPE_RGB = 1 };

struct grid {
	uint32_t theta, phi;
	float *values; /* [theta_in][theta_out][phi][3], 1/sr */
};

static uint64_t bytes_of(uint32_t size) { return HEADER_BYTES_MAX + 12 * (uint64_t)size * size * (2 * size); }

uint64_t export_mbsdf_least(void) { return bytes_of(SIZES[0]); }

/* All of one theta_in: `pairs` has room for twice its cells, for both signs of phi. */
static bool slice_fill(const struct reflectance *reflectance, uint32_t in, struct pairs *pairs, struct grid *grid)
{
	const uint32_t cells = grid->theta * grid->phi;
	const double step = M_PI_2 / grid->theta;
	float *out = grid->values + 3 * (size_t)in * cells;
	bool whole = true;
	double wi[3], wo[3];
	direction_at((in + 0.5) * step, 0, wi);
	for (uint32_t n = 0; n < cells; n++) {
		const double theta = (n / grid->phi + 0.5) * step, phi = (n % grid->phi + 0.5) * M_PI / grid->phi;
		direction_at(theta, phi, wo);
		pairs_set(pairs, 2 * (size_t)n, wi, wo);
		direction_at(theta, -phi, wo);
		pairs_set(pairs, 2 * (size_t)n + 1, wi, wo);
	}
	pairs_evaluate(pairs, reflectance);
	for (size_t n = 0; n < cells; n++)
		for (size_t c = 0; c < 3; c++) {
			const double value = 0.5 * ((double)pairs->rgb[c][2 * n] + pairs->rgb[c][2 * n + 1]);
			whole &= value < FLT_MAX;
			out[3 * n + c] = (float)fmin(value, FLT_MAX);
		}
	return whole;
}

static bp_status grid_make(const struct reflectance *reflectance, uint32_t size, struct grid *out, bp_error *error)
{
	const size_t cells = (size_t)size * (2 * size), bytes = 3 * sizeof(float) * size * cells;
	struct pairs pairs;
	*out = (struct grid){size, 2 * size, malloc(bytes)};
	bp_status status = pairs_alloc(2 * cells, &pairs) && out->values ? BP_OK : error_memory(error, bytes);
	for (uint32_t in = 0; !status && in < size; in++)
		if (!slice_fill(reflectance, in, &pairs, out))
			status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "it has values beyond what a float holds");
	pairs_free(&pairs);
	return status;
}

/* Between which two of `count` centres, and how far, `cells` cells from the beginning is. */
static uint32_t centre_of(double cells, uint32_t count, double *into)
{
	const double place = fmin(fmax(cells - 0.5, 0), count - 1.0);
	const uint32_t first = place >= count - 1.0 ? count - 2 : (uint32_t)place;
	*into = place - first;
	return first;
}

/* f cos theta_o as the MDL SDK looks it up. */
static void evaluate(const void *exported, const float wi[3], const float wo[3], double rgb[3])
{
	const struct grid *grid = exported;
	const double cosine = fmin(1, fmax(-1, (double)wi[0] * wo[0] + (double)wi[1] * wo[1])), turns = grid->theta / M_PI_2;
	const double flat = hypot(wi[0], wi[1]) * hypot(wo[0], wo[1]);
	double f[3];
	uint32_t cell[3] = {
		centre_of(atan2(hypot(wi[0], wi[1]), wi[2]) * turns, grid->theta, &f[0]),
		centre_of(atan2(hypot(wo[0], wo[1]), wo[2]) * turns, grid->theta, &f[1]),
		centre_of((flat > 0 ? acos(fmin(1, fmax(-1, cosine / flat))) : 0) * grid->phi / M_PI, grid->phi, &f[2]),
	};
	rgb[0] = rgb[1] = rgb[2] = 0;
	if (!(wi[2] > 0 && wo[2] > 0))
		return;
	for (uint32_t corner = 0; corner < 8; corner++) {
		const uint32_t a = corner >> 2, b = corner >> 1 & 1, c = corner & 1;
		const double weight = (a ? f[0] : 1 - f[0]) * (b ? f[1] : 1 - f[1]) * (c ? f[2] : 1 - f[2]) * wo[2];
		const float *value = grid->values + 3 * (((size_t)(cell[0] + a) * grid->theta + cell[1] + b) * grid->phi + cell[2] + c);
		for (int channel = 0; channel < 3; channel++)
			rgb[channel] += weight * value[channel];
	}
}

/* The smallest grid that reaches the figure and fits; else the best that fits. The caller frees its values in any case. */
static bp_status grid_choose(const struct reflectance *reflectance, uint64_t most_bytes, struct grid *out,
                             struct deviation *deviation, bp_error *error)
{
	struct deviation_reference *reference = NULL;
	bp_status status = deviation_reference_make(reflectance, &reference, error);
	*deviation = DEVIATION_WORST;
	for (int n = 0; !status && n < SIZE_COUNT && !deviation_suffices(deviation) && bytes_of(SIZES[n]) <= most_bytes; n++) {
		struct grid grid = {0};
		struct deviation reached = DEVIATION_WORST;
		status = grid_make(reflectance, SIZES[n], &grid, error);
		if (!status)
			status = deviation_measure(reference, evaluate, &grid, &reached, error);
		if (!status && reached.psnr > deviation->psnr) {
			*deviation = reached;
			free(out->values);
			*out = grid;
		} else {
			free(grid.values);
		}
	}
	deviation_reference_free(reference);
	return status;
}

/* A line of the header: printable ASCII, between quotes. */
static void text_write(struct byte_buffer *out, const char *key, const char *text)
{
	write_bytes(out, key, strlen(key));
	write_bytes(out, "=\"", 2);
	for (; *text; text++) {
		if (*text == '"' || *text == '\\')
			write_u8(out, '\\');
		write_u8(out, *text >= ' ' && *text <= '~' ? (uint8_t)*text : '?');
	}
	write_bytes(out, "\"\n", 2);
}

bp_status export_mbsdf(const struct reflectance *reflectance, const char *name, const struct export_options *options,
                       struct byte_buffer *out, struct deviation *deviation, bp_error *error)
{
	static const char MAGIC[] = "NVIDIA ARC MBSDF V1\n", DATA[] = "MBSDF_DATA=\n";
	struct grid grid = {0};
	bp_status status = grid_choose(reflectance, options->most_bytes, &grid, deviation, error);
	if (!status) {
		write_bytes(out, MAGIC, sizeof MAGIC - 1);
		text_write(out, "name", name);
		write_bytes(out, DATA, sizeof DATA - 1);
		write_u32(out, TYPE_RGB);
		write_u32(out, grid.theta);
		write_u32(out, grid.phi);
		for (size_t n = 0; n < 3 * (size_t)grid.theta * grid.theta * grid.phi && !out->failed; n++)
			write_f32(out, grid.values[n]);
		if (out->failed)
			status = error_memory(error, out->count);
	}
	free(grid.values);
	return status;
}
