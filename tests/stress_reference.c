#include "stress_reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/paper/marginal.h"
#include "model/paper/paper.h"

double relative_deviation(double found, double wanted, double floor)
{
	const double size = fmax(fabs(wanted), floor);
	return found == wanted ? 0 : fabs(found - wanted) / size;
}

void reference_fidelity(const struct lattice *truth, const struct expansion *table, struct fidelity *out)
{
	const struct lattice_dims d = truth->dims;
	long double log_squares = 0, cube_squares = 0, largest = 0;
	float *cosine_slice = malloc((size_t)d.theta_d * d.phi_d * sizeof *cosine_slice);

	if (!cosine_slice)
		abort();
	for (uint32_t i = 0; i < d.theta_h; i++) {
		lattice_corner_cosines(d, i, cosine_slice);
		for (uint32_t j = 0; j < d.theta_d; j++)
			for (uint32_t k = 0; k < d.phi_d; k++) {
				const size_t n = lattice_index(d, i, j, k);
				const long double cosine = cosine_slice[lattice_index(d, 0, j, k)];
				for (int c = 0; truth->valid[n] && c < 3; c++) {
					const long double b = truth->rgb[c][n], e = (long double)table->unit * table->rgb[c][n];
					const long double l = log10l((e + 1e-3L) / (b + 1e-3L)), r = cbrtl(b * cosine) - cbrtl(e * cosine);
					log_squares += l * l;
					cube_squares += r * r;
					largest = fmaxl(largest, fabsl(e - b) / (b + 1e-2L));
				}
			}
	}
	const long double count = 3.0L * truth->valid_count;
	out->log_rmse = (double)sqrtl(log_squares / count);
	out->cube_root_rmse = (double)sqrtl(cube_squares / count);
	out->largest_relative = (double)largest;
	free(cosine_slice);
}

/* ---- marginals ---- */

struct slow_means {
	long double sum[LATTICE_EXTENT_MAX], weight[LATTICE_EXTENT_MAX];
};

/* One factor of the three-way fit from the others' logarithms; axis 2 is phi_d. */
static void slow_turn(struct lattice_dims d, const float *value, const float *shown, long double f[3][LATTICE_EXTENT_MAX],
                      int axis)
{
	const uint32_t extents[3] = {d.theta_h, d.theta_d, d.phi_d};
	struct slow_means *means = calloc(1, sizeof *means);
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++)
			for (uint32_t k = 0; k < d.phi_d; k++) {
				const size_t n = lattice_index(d, i, j, k);
				const uint32_t at[3] = {i, j, k};
				const long double w = shown[n] * (i < paper_shared_from(d.theta_h) ? 1.0L : 0.1L);
				long double rest = log2l(fmaxl(value[n], 3e-4L));
				for (int other = 0; other < 3; other++)
					rest -= other == axis ? 0 : f[other][at[other]];
				means->sum[at[axis]] += w * rest;
				means->weight[at[axis]] += w;
			}
	for (uint32_t i = 0; i < extents[axis]; i++) {
		const long double otherwise = axis == 2 || !i ? 0 : f[axis][i - 1];
		long double m = means->weight[i] > 0 ? means->sum[i] / means->weight[i] : otherwise;
		if (axis)
			m = fmaxl(-4.32L, fminl(4.32L, m));
		f[axis][i] = m;
	}
	free(means);
}

double reference_marginals(const struct lattice *lattice)
{
	const struct lattice_dims d = lattice->dims;
	const size_t cells = lattice_cells(d);
	static long double f[3][LATTICE_EXTENT_MAX];
	float *value = malloc(3 * cells * sizeof *value);
	struct importance *importance;
	struct marginals found;
	double worst = 0;

	if (!value || importance_create(d, &importance, NULL) != BP_OK || marginals_alloc(d, &found, NULL) != BP_OK)
		abort();
	importance_weigh(importance, lattice, 1, importance_unit(importance, lattice), value, value + cells);
	importance_shown(importance, lattice, value + 2 * cells);
	if (marginals_fit(d, value, value + 2 * cells, &found, NULL) != BP_OK)
		return -1;
	memset(f, 0, sizeof f);
	for (int turn = 0; turn < 3; turn++) {
		for (int round = 0; round < 8; round++) {
			slow_turn(d, value, value + 2 * cells, f, 0);
			slow_turn(d, value, value + 2 * cells, f, 1);
		}
		slow_turn(d, value, value + 2 * cells, f, 2);
	}
	for (uint32_t i = 0; i < d.theta_h; i++)
		worst = fmax(worst, found.h[i] > 0 ? fabs((double)(log2l(found.h[i]) - f[0][i])) : 0);
	for (uint32_t j = 0; j < d.theta_d; j++)
		worst = fmax(worst, fabs((double)(log2l(found.d[j]) - f[1][j])));
	for (uint32_t k = 0; k < d.phi_d; k++)
		worst = fmax(worst, fabs((double)(log2l(found.phi[k]) - f[2][k])));
	free(found.h);
	free(importance);
	free(value);
	return worst;
}
