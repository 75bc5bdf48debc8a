/* default_grid.c: axes, step, centres and the end of the lowest plane, from the coefficients of a decoded table. */
#include "default_grid_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"

enum {
	CLUSTER_LEAST = 4, /* coefficients that tell a place on the grid */
	NEAR_LEAST = 24,   /* fewer on the grid prove nothing */
};

/* ---- axes ---- */

/* Axis 0: the mean of the vectors of level 1 around it, ever nearer. Returns their length. */
static double first_axis_find(const struct grid_evidence *e, double length, double axis[3][3])
{
	static const double WIDTH[3] = {0.01, 0.003, 0.002}, COSINE[3] = {0.95, 0.999, 0.9999};

	for (int turn = 0; turn < 3; turn++) {
		double sum[3] = {0}, lengths = 0, count = 0;
		GRID_FOR_EACH(e, r, at) {
			const double size = grid_length(e, at), part = grid_along(e, at, axis[0]);
			if (fabs(size - length) > WIDTH[turn] * length || fabs(part) < COSINE[turn] * size)
				continue;
			for (int c = 0; c < 3; c++)
				sum[c] += part < 0 ? -(double)e->spectrum[c][at] : (double)e->spectrum[c][at];
			lengths += size;
			count++;
		}
		if (count < CLUSTER_LEAST)
			break;
		grid_axis_set(axis, 0, sum);
		length = lengths / count;
	}
	return length;
}

/*
 * Axes 1 and 2, which a guess may have turned by any angle, as they are often nearly alike: what lies across axis 0 and is as long as
 * a level of 1 lies along one of them, so its direction is known but for quarter turns.
 */
static void other_axes_find(const struct grid_evidence *e, double length, double axis[3][3])
{
	static const double WIDTH[3] = {0.01, 0.003, 0.002}, ANGLE[3] = {M_PI, 0.1, 0.02};

	for (int turn = 0; turn < 3; turn++) {
		double cosines = 0, sines = 0, count = 0, next[2][3];
		GRID_FOR_EACH(e, r, at) {
			if (grid_length(e, at) < 0.9 * length)
				continue;
			const double u = grid_along(e, at, axis[1]), v = grid_along(e, at, axis[2]), four = 4 * atan2(v, u);
			if (fabs(hypot(u, v) - length) > WIDTH[turn] * length || fabs(remainder(four, 2 * M_PI)) > 4 * ANGLE[turn])
				continue;
			cosines += cos(four);
			sines += sin(four);
			count++;
		}
		if (count < CLUSTER_LEAST)
			break;
		const double turned = atan2(sines, cosines) / 4;
		for (int c = 0; c < 3; c++) {
			next[0][c] = cos(turned) * axis[1][c] + sin(turned) * axis[2][c];
			next[1][c] = cos(turned) * axis[2][c] - sin(turned) * axis[1][c];
		}
		grid_axis_set(axis, 1, next[0]);
		grid_axis_set(axis, 2, next[1]);
	}
}

/* ---- step and centres ---- */

/* The mean of field 0's sizes in the fullest of many narrow windows; 0 where there are too few. */
static double cluster_find(const struct grid_evidence *e, const double axis[3], double from, double to)
{
	enum { WINDOWS = 256 };
	double count[WINDOWS] = {0}, sum[WINDOWS] = {0};
	int best = 0;

	GRID_FOR_EACH(e, r, at) {
		const double size = fabs(grid_along(e, at, axis));
		if (size < from || size >= to)
			continue;
		const int w = (int)((size - from) / (to - from) * WINDOWS);
		count[w < WINDOWS ? w : WINDOWS - 1]++;
		sum[w < WINDOWS ? w : WINDOWS - 1] += size;
	}
	for (int w = 1; w < WINDOWS; w++)
		best = count[w] > count[best] ? w : best;
	return count[best] >= CLUSTER_LEAST ? sum[best] / count[best] : 0;
}

/* A line through field 0's sizes of levels 2 and up, at first of near ones: their step, and where level 2 lies. */
static void line_fit(const struct grid_evidence *e, const double axis[3], double *step, double *second)
{
	for (int turn = 0; turn < 3; turn++) {
		const double last = 2 << (2 * turn);
		double n = 0, a = 0, b = 0, aa = 0, ab = 0;
		GRID_FOR_EACH(e, r, at) {
			const double size = fabs(grid_along(e, at, axis)), past = floor((size - *second) / *step + 0.5); /* levels past 2 */
			if (past < 0 || past > last || fabs(size - *second - past * *step) > 0.05 * *step)
				continue;
			n++;
			a += past;
			b += size;
			aa += past * past;
			ab += past * size;
		}
		const double spread = n * aa - a * a;
		if (spread <= 0)
			return;
		*step = (n * ab - a * b) / spread;
		*second = (b - *step * a) / n;
	}
}

uint32_t default_grid_level(const struct default_grid *g, float size, uint32_t low, float *at)
{
	const float unit = (float)(1u << low), one = low ? g->centre[2] : g->centre[0], more = low ? g->centre[2] : g->centre[1];
	const float in = size / unit;
	uint32_t level = 0;

	if (in >= (1 + one) / 2) {
		level = (uint32_t)fminf(in - more + 0.5f, (float)(1u << DEFAULT_PLANES_MAX) / unit - 1);
		if (level < 2)
			level = in < (3 + one + more) / 2 ? 1 : 2;
	}
	*at = level ? unit * ((float)level + (level > 1 ? more : one)) : 0;
	return level << low;
}

/* False: these could not be a record's. */
static bool step_find(const struct grid_evidence *e, const double axis[3], double first, struct default_grid *g)
{
	double second = cluster_find(e, axis, 1.6 * first, 2.2 * first);
	const double third = second > 0 ? cluster_find(e, axis, second + 0.8 * first, second + 1.1 * first) : 0;
	double step = third > 0 ? third - second : second > 0 ? second - first : first;

	second = second > 0 ? second : 2 * step;
	line_fit(e, axis, &step, &second);
	g->step = (float)step;
	g->centre[0] = (float)(first / step - 1);
	g->centre[1] = (float)(second / step - 2);
	g->centre[2] = DEFAULT_CENTRE_BELOW;
	return g->step > 0 && fabsf(g->centre[0]) <= 0.5f && fabsf(g->centre[1]) <= 0.5f;
}

/* ---- harmonic 0, and the end of the lowest plane ---- */

/* By how much the coefficients of the coarsest band of field f miss the grid all alike; 0 where they do not. */
static double offset_find(const struct grid_evidence *e, uint32_t f, const double axis[3], const struct default_grid *g)
{
	const bool low = f * e->dims.phi_d >= g->end;
	const double step = (double)g->step * (low ? 2 : 1), centre = (double)g->centre[low ? 2 : 1];
	double cosines = 0, sines = 0, count = 0;

	GRID_FOR_EACH(e, r, at) {
		if (at > r * e->dims.phi_d)
			break; /* lane 0 is harmonic 0 */
		const double size = grid_along(e, at, axis) / step;
		if (!grid_is_coarsest(e->dims, r, 0) || fabs(size) < 2)
			continue;
		const double turn = 2 * M_PI * (size - copysign(centre, size));
		cosines += cos(turn);
		sines += sin(turn);
		count++;
	}
	return count >= 3 && hypot(cosines, sines) > 0.8 * count ? atan2(sines, cosines) / (2 * M_PI) * step : 0;
}

/* By how much, within reason, every harmonic of one field lies nearer to the grid whose lowest plane is missing. */
static void coarse_gains(const struct grid_evidence *e, const double axis[3], const struct default_grid *g, double *gain)
{
	memset(gain, 0, e->dims.phi_d * sizeof *gain);
	GRID_FOR_EACH(e, r, at) {
		const uint32_t m = spectrum_harmonic(e->dims.phi_d, (uint32_t)(at - r * e->dims.phi_d));
		const float size = (float)fabs(grid_along(e, at, axis)) / g->step;
		float fine, coarse;
		if (size < 0.5f || grid_is_coarsest(e->dims, r, m)) /* which may be off by a constant */
			continue;
		default_grid_level(g, size, 0, &fine);
		default_grid_level(g, size, 1, &coarse);
		gain[m] += (double)(fminf(fabsf(size - fine), 0.2f) - fminf(fabsf(size - coarse), 0.2f));
	}
}

/* The unit from which on the gains are taken, so that their sum is largest. */
static uint32_t end_of(const double *gain, uint32_t units, double *largest)
{
	uint32_t end = units;
	double sum = 0;

	*largest = 0;
	for (uint32_t u = units; u-- > 0;) {
		sum += gain[u];
		if (sum > *largest) {
			*largest = sum;
			end = u;
		}
	}
	return end;
}

/* Axes 1 and 2, of which either may have been the first, change places where the lowest plane's end explains more then. */
static bp_status end_find(const struct grid_evidence *e, double axis[3][3], struct default_grid *g, bp_error *error)
{
	const size_t p = e->dims.phi_d;
	double *gain = malloc(6 * p * sizeof *gain), explained[2];

	if (!gain)
		return error_memory(error, 6 * p * sizeof *gain);
	double *swapped = gain + 3 * p;
	for (size_t f = 0; f < 3; f++) {
		coarse_gains(e, axis[f], g, gain + f * p);
		memcpy(swapped + (f ? 3 - f : 0) * p, gain + f * p, p * sizeof *gain);
	}
	const uint32_t end = end_of(gain, 3 * e->dims.phi_d, &explained[0]), end_swapped = end_of(swapped, 3 * e->dims.phi_d, &explained[1]);
	const bool swap = explained[1] > explained[0];
	free(gain);
	g->end = swap ? end_swapped : end;
	for (int c = 0; c < 3 && swap; c++) {
		const double kept = axis[1][c];
		axis[1][c] = axis[2][c];
		axis[2][c] = kept;
	}
	return BP_OK;
}

bp_status default_grid_find(const struct grid_evidence *e, float length, const float guess[3][3], struct default_grid *g, bool *found, bp_error *error)
{
	double axis[3][3];

	*found = false;
	for (int f = 0; f < 3; f++)
		grid_axis_set(axis, f, (const double[]){(double)guess[f][0], (double)guess[f][1], (double)guess[f][2]});
	const double first = first_axis_find(e, (double)length, axis);
	for (int f = 1; f < 3; f++)
		grid_axis_set(axis, f, (const double[]){(double)guess[f][0], (double)guess[f][1], (double)guess[f][2]});
	other_axes_find(e, first, axis);
	if (!step_find(e, axis[0], first, g))
		return BP_OK;
	grid_refine(e, axis, g);
	if (!(g->step > 0 && g->step <= 0x1p40f && fabsf(g->centre[1]) <= 0.5f))
		return BP_OK;
	bp_status status = end_find(e, axis, g, error);
	for (int f = 0; !status && f < 3; f++) {
		g->offset[f] = (float)offset_find(e, (uint32_t)f, axis[f], g);
		for (int c = 0; c < 3; c++)
			g->axis[f][c] = (float)axis[f][c];
	}
	*found = !status;
	return status;
}

double default_grid_missed(const struct grid_evidence *e, const struct default_grid *g)
{
	const uint32_t p = e->dims.phi_d;
	size_t count = 0, near = 0;
	double squares = 0;

	for (uint32_t f = 0; f < 3; f++) {
		const double axis[3] = {(double)g->axis[f][0], (double)g->axis[f][1], (double)g->axis[f][2]};
		GRID_FOR_EACH(e, r, at) {
			const uint32_t m = spectrum_harmonic(p, (uint32_t)(at - r * p));
			const float size = (float)fabs(grid_along(e, at, axis) - (grid_is_coarsest(e->dims, r, m) ? (double)g->offset[f] : 0)) / g->step;
			float place;
			default_grid_level(g, size, f * p + m >= g->end, &place);
			squares += (double)(size - place) * (double)(size - place);
			count += size >= 0.2f;
			near += size >= 0.2f && fabsf(size - place) < 0.02f;
		}
	}
	return near >= NEAR_LEAST && near >= count / 8 ? squares * 12 / (double)count : INFINITY;
}
