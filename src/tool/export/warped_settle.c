/* warped_settle.c: samples of an exported file that are right in the mean of what is interpolated between them. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "rgl/grid.h"
#include "warped.h"

/* Gauss's two points of a unit step: on these the mean of a cubic is that of its values. */
static const double GAUSS[2] = {0.21132486540518712, 0.78867513459481288};

enum {
	PARTS = 4,
	SIDES = 2,
	SUMS = 4,
	ROUNDS = 4
}; /* points in a cell of (s, t); slices around it; three channels and the weight */

/* Points between two angles of incidence, the first half of them nearer to the first one. */
struct probes {
	size_t count;
	struct pairs pairs;
	double *factor;  /* [count]: makes of f what `rgb` holds; 0 where w_o is not above the horizon */
	double (*at)[2]; /* [count]: (s, t) */
	double *sum;     /* [SIDES][SUMS][points]: what is missing, times its weight at each sample; the weights */
};

static bp_status probes_alloc(uint32_t size, struct probes *probes, bp_error *error)
{
	const size_t cells = size - 1, points = (size_t)size * size;
	*probes = (struct probes){.count = cells * cells * PARTS};
	probes->factor = malloc(probes->count * sizeof *probes->factor);
	probes->at = malloc(probes->count * sizeof *probes->at);
	probes->sum = calloc(SIDES * SUMS * points, sizeof *probes->sum);
	const bool there = pairs_alloc(probes->count, &probes->pairs) && probes->factor && probes->at && probes->sum;
	return there ? BP_OK : error_memory(error, probes->count * (sizeof *probes->factor + sizeof *probes->at));
}

static void probes_free(struct probes *probes)
{
	pairs_free(&probes->pairs);
	free(probes->factor);
	free(probes->at);
	free(probes->sum);
}

/* One of the two slices' points: in every cell two, on a diagonal, so that both slices' make a square. */
static void probes_place(const struct warped *warped, uint32_t angle, uint32_t side, struct probes *probes)
{
	const struct normals *normals = &warped->normals;
	const uint32_t cells = warped->shape.size - 1;
	const double theta_i = warped->theta_i[angle] + GAUSS[side] * ((double)warped->theta_i[angle + 1] - warped->theta_i[angle]);
	const double area = normals_at(normals, normals->area, normals_u(theta_i));
	const size_t half = probes->count / 2;
	double wi[3], u[2], wo[3];
	direction_at(theta_i, 0, wi);
	for (size_t n = side * half; n < (side + 1) * half; n++) {
		const uint32_t cell = (uint32_t)(n % half / 2), part = n % 2;
		const double at[2] = {(cell % cells + GAUSS[part]) / cells, (cell / cells + GAUSS[part ^ side]) / cells};
		warp_forward(&warped->visible, angle + side, at, u);
		visible_mirror(wi, u, wo);
		pairs_set(&probes->pairs, n, wi, wo);
		probes->factor[n] = fmax(wo[2], 0) * 4 * area / normals_at(normals, normals->density, u[0]);
		warp_inverse(&warped->visible, (struct warp_place){angle, GAUSS[side]}, u, probes->at[n]);
	}
}

/* Adds what is missing at one point to the sums of the eight samples around it. */
static void probe_add(const struct warped *warped, uint32_t angle, size_t n, struct probes *probes)
{
	const size_t size = warped->shape.size, points = size * size;
	const double next = GAUSS[n >= probes->count / 2], side[SIDES] = {1 - next, next};
	double fx, fy, missing[3];
	const size_t corner = grid_node(probes->at[n][0], size, &fx) + size * grid_node(probes->at[n][1], size, &fy);
	const size_t sample[4] = {corner, corner + 1, corner + size, corner + size + 1};
	const double weight[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
	for (size_t c = 0; c < 3; c++) {
		missing[c] = (double)probes->pairs.rgb[c][n] * probes->factor[n];
		for (size_t s = 0; s < SIDES; s++)
			for (int k = 0; k < 4; k++)
				missing[c] -= side[s] * weight[k] * warped->rgb[((angle + s) * 3 + c) * points + sample[k]];
	}
	for (size_t s = 0; s < SIDES; s++)
		for (int k = 0; k < 4; k++) {
			double *sum = probes->sum + s * SUMS * points + sample[k];
			for (size_t c = 0; c < 3; c++)
				sum[c * points] += side[s] * weight[k] * missing[c];
			sum[3 * points] += side[s] * weight[k];
		}
}

/*
 * A slice takes the means of its sums. Samples above the horizon stay at 0 or above: not all readers cut f there, and light below
 * 0 is worse than a mean that is too bright.
 */
static void slice_settle(struct warped *warped, uint32_t angle, const double *sum)
{
	const size_t points = (size_t)warped->shape.size * warped->shape.size;
	for (size_t c = 0; c < 3; c++) {
		float *plane = warped->rgb + (angle * 3 + c) * points;
		for (size_t n = 0; n < points; n++) {
			const double least = plane[n] < 0 ? -FLT_MAX : 0;
			if (sum[3 * points + n] > 0)
				plane[n] = (float)fmax(fmin(plane[n] + sum[c * points + n] / sum[3 * points + n], FLT_MAX), least);
		}
	}
}

/* One round over all slices. The sums are 0 before. */
static void round_run(const struct reflectance *reflectance, struct warped *warped, struct probes *probes)
{
	const size_t sums = SUMS * (size_t)warped->shape.size * warped->shape.size;
	const uint32_t last = warped->shape.angles - 1;
	for (uint32_t angle = 0; angle < last; angle++) {
		for (uint32_t side = 0; side < SIDES; side++)
			probes_place(warped, angle, side, probes);
		pairs_evaluate(&probes->pairs, reflectance);
		for (size_t n = 0; n < probes->count; n++)
			if (probes->factor[n] > 0)
				probe_add(warped, angle, n, probes);
		/* nothing that comes later in this round reads this slice */
		slice_settle(warped, angle, probes->sum);
		memcpy(probes->sum, probes->sum + sums, sums * sizeof *probes->sum);
		memset(probes->sum + sums, 0, sums * sizeof *probes->sum);
	}
	slice_settle(warped, last, probes->sum);
	memset(probes->sum, 0, sums * sizeof *probes->sum);
}

bp_status warped_settle(const struct reflectance *reflectance, struct warped *warped, bp_error *error)
{
	struct probes probes;
	bp_status status = probes_alloc(warped->shape.size, &probes, error);
	for (int round = 0; !status && round < ROUNDS; round++)
		round_run(reflectance, warped, &probes);
	probes_free(&probes);
	return status;
}
