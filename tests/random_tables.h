/*
 * random_tables.h: extents of all kinds, numbers that look random and are the same in every run, and terms of spectra.
 */
#ifndef RANDOM_TABLES_H
#define RANDOM_TABLES_H

#include <stdlib.h>

#include "model/spectral/spectrum_inverse.h"
#include "random.h"

static const struct lattice_dims DIMS[] = {{4, 4, 4},   {5, 7, 9},    {15, 16, 5},  {16, 15, 6},
                                           {31, 33, 7}, {29, 18, 33}, {90, 30, 20}, {4, 60, 17}};
enum { DIMS_COUNT = sizeof DIMS / sizeof *DIMS };

/* All terms of a spectrum that are not 0, by harmonic: start[P + 1]. malloc'ed. */
__attribute__((unused)) static struct spectrum_term *terms_of(const struct spectrum_inverse *inverse, const float *spectrum,
                                                              uint32_t *start)
{
	const struct lattice_dims d = inverse->dims;
	struct spectrum_term *terms = malloc((lattice_cells(d) + 1) * sizeof *terms);
	uint32_t n = 0;
	for (uint32_t m = 0; m < d.phi_d; m++) {
		start[m] = n;
		for (uint32_t r = 0; r < d.theta_h * d.theta_d; r++) {
			const float value = spectrum[(size_t)r * d.phi_d + spectrum_lane(d.phi_d, m)];
			if (value != 0)
				terms[n++] = spectrum_term_make(inverse, r, m, value);
		}
	}
	start[d.phi_d] = n;
	return terms;
}

#endif
