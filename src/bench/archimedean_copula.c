#include "archimedean_copula.h"

#include <math.h>
#include <stdbool.h>

double archimedean_density(enum archimedean_family family, double alpha, double u, double v, double w)
{
	if (family == ARCHIMEDEAN_FRANK) {
		const double x = -expm1(-alpha * u), y = -expm1(-alpha * v), z = -expm1(-alpha * w), p = -expm1(-alpha);
		const double s = x * y * z / (p * p), rest = 1 - s;
		return alpha * alpha * s * (1 + s) / (rest * rest * rest) * exp(-alpha * (u + v + w)) / (x * y * z);
	}
	/* one factor is huge where the other is tiny: in logarithms neither leaves the range of a double */
	const double sum = pow(u, -alpha) + pow(v, -alpha) + pow(w, -alpha) - 2;
	return (1 + alpha) * (1 + 2 * alpha) * exp(-(alpha + 1) * log(u * v * w) - (1 / alpha + 3) * log(sum));
}

struct copula_edge copula_edge(enum archimedean_family family, double alpha, double u)
{
	if (family == ARCHIMEDEAN_FRANK)
		return (struct copula_edge){-expm1(-alpha * u), exp(-alpha * u)};
	return (struct copula_edge){pow(u, -alpha), 0};
}

struct copula copula_make(enum archimedean_family family, double alpha)
{
	const double p = -expm1(-alpha), e = exp(-alpha);

	return (struct copula){family, alpha, -1 / alpha, p * p, e * e - 2 * e};
}

/*
 * 1 - s. Where s is near 1 the difference would keep few digits, so there, with x = e^-alpha u and so on,
 *
 *     p^2 (1 - s) = x + y + z - 2 e^-alpha + e^-2 alpha - (x y + y z + z x) + x y z
 */
static double frank_rest(const struct copula *copula, struct copula_edge u, struct copula_edge v, struct copula_edge w)
{
	const double s = u.a * v.a * w.a / copula->p2;

	if (s < 0.5)
		return 1 - s;
	return (u.b + v.b + w.b + copula->below - (u.b * v.b + v.b * w.b + w.b * u.b) + u.b * v.b * w.b) / copula->p2;
}

double copula_value(const struct copula *copula, struct copula_edge u, struct copula_edge v, struct copula_edge w)
{
	if (copula->family == ARCHIMEDEAN_FRANK)
		return -log(frank_rest(copula, u, v, w)) / copula->alpha;
	return pow(u.a + v.a + w.a - 2, copula->power);
}

double copula_cell_mass(const struct copula *copula, const struct copula_edge u[2], const struct copula_edge v[2],
                        const struct copula_edge w[2])
{
	const bool frank = copula->family == ARCHIMEDEAN_FRANK;
	double sum = 0, odd = 1, even = 1;

	for (int corner = 0; corner < 8; corner++) {
		const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2, is_odd = (a + b + c) & 1;
		if (frank) {
			*(is_odd ? &odd : &even) *= frank_rest(copula, u[a], v[b], w[c]);
		} else {
			const double value = copula_value(copula, u[a], v[b], w[c]);
			sum += is_odd ? value : -value;
		}
	}
	return frank ? log(even / odd) / copula->alpha : sum; /* one logarithm for the eight: each 1 - s is at least e^-alpha */
}
