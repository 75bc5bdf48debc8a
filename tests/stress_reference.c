#include "stress_reference.h"

#include <math.h>
#include <stdlib.h>

#include "model/paper/marginal.h"

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
	struct corner_cosines *cosines;

	if (!cosine_slice || corner_cosines_create(d, &cosines, NULL) != BP_OK)
		abort();
	for (uint32_t i = 0; i < d.theta_h; i++) {
		corner_cosines_slice(cosines, i, cosine_slice);
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
	free(cosines);
}

/* ---- marginals ---- */

struct sums {
	long double *sum;
	uint32_t *count;
};

static void sums_alloc(struct sums *s, size_t n)
{
	s->sum = calloc(n, sizeof *s->sum);
	s->count = calloc(n, sizeof *s->count);
}

static double means_deviation(const struct means *means, struct sums *s, size_t n, long double mean)
{
	double worst = 0;
	for (size_t i = 0; i < n; i++) {
		const long double exact = s->count[i] && mean > 0 ? s->sum[i] / s->count[i] / mean : 0;
		const long double wanted = exact < DENSITY_DARK ? 0 : exact;
		if (means->valid[i] != (s->count[i] != 0) || means->count[i] != s->count[i])
			worst = INFINITY;
		/* below 1e-290 of the mean a double may have lost digits */
		worst = fmax(worst, (double)(fabsl(means->value[i] - wanted) / fmaxl(wanted, 1e-290L)));
	}
	free(s->sum);
	free(s->count);
	return worst;
}

double reference_marginals(const struct lattice *lattice)
{
	const struct lattice_dims d = lattice->dims;
	struct density density;
	struct sums h, td, p, hd, hp;
	long double total = 0, mean;
	double worst;

	if (density_build(lattice, &density, NULL) != BP_OK)
		return -1;
	sums_alloc(&h, d.theta_h);
	sums_alloc(&td, d.theta_d);
	sums_alloc(&p, d.phi_d);
	sums_alloc(&hd, (size_t)d.theta_h * d.theta_d);
	sums_alloc(&hp, (size_t)d.theta_h * d.phi_d);
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++)
			for (uint32_t k = 0; k < d.phi_d; k++) {
				const size_t n = lattice_index(d, i, j, k);
				const long double v = ((long double)lattice->rgb[0][n] + lattice->rgb[1][n] + lattice->rgb[2][n]) / 3;
				long double *const to[5] = {&h.sum[i], &td.sum[j], &p.sum[k], &hd.sum[(size_t)i * d.theta_d + j],
				                            &hp.sum[(size_t)i * d.phi_d + k]};
				uint32_t *const counts[5] = {&h.count[i], &td.count[j], &p.count[k], &hd.count[(size_t)i * d.theta_d + j],
				                             &hp.count[(size_t)i * d.phi_d + k]};
				for (int t = 0; lattice->valid[n] && t < 5; t++) {
					*to[t] += v;
					++*counts[t];
				}
				total += lattice->valid[n] ? v : 0;
			}
	mean = total / lattice->valid_count;
	worst = (double)(fabsl(density.mean - mean) / fmaxl(mean, 1e-290L)); /* below, K is a denormal number */
	worst = fmax(worst, means_deviation(&density.axis[0], &h, d.theta_h, mean));
	worst = fmax(worst, means_deviation(&density.axis[1], &td, d.theta_d, mean));
	worst = fmax(worst, means_deviation(&density.axis[2], &p, d.phi_d, mean));
	worst = fmax(worst, means_deviation(&density.hd, &hd, (size_t)d.theta_h * d.theta_d, mean));
	worst = fmax(worst, means_deviation(&density.hphi, &hp, (size_t)d.theta_h * d.phi_d, mean));
	density_free(&density);
	return worst;
}
