#include "copula.h"

#include <string.h>

static double ratio(double numerator, double denominator, uint8_t *defined)
{
	*defined = denominator > 0;
	return denominator > 0 ? numerator / denominator : 0;
}

static void copula_pair(const struct means *pair, const struct means *row, const struct means *column, uint32_t rows,
                        uint32_t columns, double *value, uint8_t *defined)
{
	for (uint32_t r = 0; r < rows; r++)
		for (uint32_t c = 0; c < columns; c++) {
			const size_t at = (size_t)r * columns + c;
			value[at] = ratio(pair->value[at], row->value[r] * column->value[c], &defined[at]);
			if (!pair->valid[at]) {
				defined[at] = 0;
				value[at] = 0;
			}
		}
}

void copula_hd(const struct density *density, double *value, uint8_t *defined)
{
	copula_pair(&density->hd, &density->axis[0], &density->axis[1], density->dims.theta_h, density->dims.theta_d, value, defined);
}

void copula_hphi(const struct density *density, double *value, uint8_t *defined)
{
	copula_pair(&density->hphi, &density->axis[0], &density->axis[2], density->dims.theta_h, density->dims.phi_d, value, defined);
}

/* 1/x where x > 0, else 0: the product is then 0 too, and the cell undefined. */
static double reciprocal(double x)
{
	return x > 0 ? 1 / x : 0;
}

void copula_slice(const struct density *density, uint32_t i, double *value, uint8_t *defined)
{
	const struct lattice_dims d = density->dims;
	const double *hphi = density->hphi.value + (size_t)i * d.phi_d;
	double column[LATTICE_EXTENT_MAX];

	for (uint32_t k = 0; k < d.phi_d; k++)
		column[k] = reciprocal(hphi[k]);
	for (uint32_t j = 0; j < d.theta_d; j++) {
		const size_t at = lattice_index(d, i, j, 0), to = (size_t)j * d.phi_d;
		const double *v = density->value + at;
		const uint8_t *valid = density->valid + at;
		/* h/(hd hphi) in this order: both quotients are near 1 and cannot overflow together */
		const double row = density->axis[0].value[i] * reciprocal(density->hd.value[(size_t)i * d.theta_d + j]);

		for (uint32_t k = 0; k < d.phi_d; k++) {
			double inverse = row * column[k];
			value[to + k] = v[k] * inverse;
			defined[to + k] = valid[k] && inverse > 0;
		}
	}
}

void copula_shared(const struct density *density, uint32_t from, double *value, uint8_t *defined)
{
	const struct lattice_dims d = density->dims;
	double numerator[LATTICE_EXTENT_MAX], denominator[LATTICE_EXTENT_MAX];

	for (uint32_t j = 0; j < d.theta_d; j++) {
		memset(numerator, 0, d.phi_d * sizeof *numerator);
		memset(denominator, 0, d.phi_d * sizeof *denominator);
		for (uint32_t i = from; i < d.theta_h; i++) {
			const size_t at = lattice_index(d, i, j, 0);
			const double row = density->hd.value[(size_t)i * d.theta_d + j] * reciprocal(density->axis[0].value[i]);
			const double *hphi = density->hphi.value + (size_t)i * d.phi_d;

			for (uint32_t k = 0; k < d.phi_d; k++) {
				numerator[k] += density->value[at + k]; /* 0 where invalid */
				denominator[k] += density->valid[at + k] ? row * hphi[k] : 0;
			}
		}
		for (uint32_t k = 0; k < d.phi_d; k++)
			value[(size_t)j * d.phi_d + k] = ratio(numerator[k], denominator[k], &defined[(size_t)j * d.phi_d + k]);
	}
}
