/* default_grid_refine.c: more digits of a grid that is nearly known, and of the unit of the logarithm. */
#include "default_grid_parts.h"

#include <math.h>

void grid_axis_set(double axis[3][3], int n, const double a[3])
{
	double rest[3] = {a[0], a[1], a[2]};

	for (int m = 0; m < n; m++) {
		const double part = rest[0] * axis[m][0] + rest[1] * axis[m][1] + rest[2] * axis[m][2];
		for (int c = 0; c < 3; c++)
			rest[c] -= part * axis[m][c];
	}
	const double length = sqrt(rest[0] * rest[0] + rest[1] * rest[1] + rest[2] * rest[2]);
	for (int c = 0; c < 3; c++)
		axis[n][c] = rest[c] / length;
}

enum { UNKNOWNS = 5 };

/* Solves a x = b for a symmetric positive definite matrix, by elimination; false where it is not one. */
static bool solve(double a[UNKNOWNS][UNKNOWNS], double b[UNKNOWNS])
{
	for (int i = 0; i < UNKNOWNS; i++) {
		if (!(a[i][i] > 0))
			return false;
		for (int j = i + 1; j < UNKNOWNS; j++) {
			const double factor = a[j][i] / a[i][i];
			for (int k = i; k < UNKNOWNS; k++)
				a[j][k] -= factor * a[i][k];
			b[j] -= factor * b[i];
		}
	}
	for (int i = UNKNOWNS - 1; i >= 0; i--) {
		for (int k = i + 1; k < UNKNOWNS; k++)
			b[i] -= a[i][k] * b[k];
		b[i] /= a[i][i];
	}
	return true;
}

/*
 * Least squares over coefficients of ever larger levels: a small turn w, which makes
 * y + w x y of the fields' values y, a factor 1 + s of the step, and where levels lie beyond it.
 */
void grid_refine(const struct grid_evidence *e, double axis[3][3], struct default_grid *g)
{
	double step = (double)g->step;

	for (double most = 32; most <= 0x1p17; most *= 4) {
		double a[UNKNOWNS][UNKNOWNS] = {{0}}, b[UNKNOWNS] = {0}, next[3][3];
		GRID_FOR_EACH(e, r, at) {
			if (grid_length(e, at) < 0.9 * step || grid_is_coarsest(e->dims, r, spectrum_harmonic(e->dims.phi_d, (uint32_t)(at - r * e->dims.phi_d))))
				continue;
			const double y[3] = {grid_along(e, at, axis[0]), grid_along(e, at, axis[1]), grid_along(e, at, axis[2])};
			for (int f = 0; f < 3; f++) {
				const int u = (f + 1) % 3, v = (f + 2) % 3;
				float place;
				if (fmax(fabs(y[0]), fmax(fabs(y[1]), fabs(y[2]))) > most * step)
					continue;
				const uint32_t level = default_grid_level(g, (float)(fabs(y[f]) / step), 0, &place);
				const double target = copysign((double)place * step, y[f]), missed = target - y[f];
				if (fabs(missed) > 0.1 * step)
					continue;
				/* (w x y)_f = w_u y_v - w_v y_u */
				double row[UNKNOWNS] = {0};
				row[u] = y[v];
				row[v] = -y[u];
				row[3] = -target;
				row[4] = level > 1 ? -copysign(step, target) : 0;
				for (int i = 0; i < UNKNOWNS; i++) {
					b[i] += row[i] * missed;
					for (int j = 0; j < UNKNOWNS; j++)
						a[i][j] += row[i] * row[j];
				}
			}
		}
		for (int i = 0; i < UNKNOWNS; i++)
			a[i][i] += 1e-9 * a[3][3]; /* a grey material has no turn about its axis */
		if (!solve(a, b))
			return;
		for (int c = 0; c < 3; c++)
			for (int f = 0; f < 3; f++)
				next[f][c] = axis[f][c] + b[(f + 1) % 3] * axis[(f + 2) % 3][c] - b[(f + 2) % 3] * axis[(f + 1) % 3][c];
		for (int f = 0; f < 3; f++)
			grid_axis_set(axis, f, next[f]);
		step *= 1 + b[3];
		g->centre[1] += (float)b[4];
	}
	g->step = (float)step;
}

double default_grid_unit_error(const struct grid_evidence *e, const struct default_grid *g, float *const slope[3], double reach)
{
	double missed_slope = 0, slope2 = 0;

	for (uint32_t f = 0; f < 3; f++) {
		const double axis[3] = {(double)g->axis[f][0], (double)g->axis[f][1], (double)g->axis[f][2]};
		GRID_FOR_EACH(e, r, at) {
			const uint32_t m = spectrum_harmonic(e->dims.phi_d, (uint32_t)(at - r * e->dims.phi_d));
			const double s = axis[0] * (double)slope[0][at] + axis[1] * (double)slope[1][at] + axis[2] * (double)slope[2][at];
			const double y = grid_along(e, at, axis);
			float place;
			if (fabs(s) * reach > 0.2 * (double)g->step || grid_is_coarsest(e->dims, r, m))
				continue;
			default_grid_level(g, (float)fabs(y) / g->step, f * e->dims.phi_d + m >= g->end, &place);
			const double missed = y - copysign((double)(place * g->step), y);
			if (fabs(missed) > 0.3 * (double)g->step)
				continue;
			missed_slope += missed * s;
			slope2 += s * s;
		}
	}
	return slope2 > 0 ? missed_slope / slope2 : 0;
}
