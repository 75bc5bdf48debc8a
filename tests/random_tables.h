/*
 * random_tables.h: extents of all kinds, numbers that look random and are the same in every run, and terms of spectra.
 */
#ifndef RANDOM_TABLES_H
#define RANDOM_TABLES_H

#include <stdlib.h>

#include "model/spectral/spectrum_rows.h"
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

/* The table of a spectrum, whole, or every second cell along all axes; rows cut at `limit` (spans.h). malloc'ed. */
__attribute__((unused)) static float *table_of(struct lattice_dims d, float limit, const float *spectrum, bool half)
{
	const uint32_t every = half ? 2 : 1, rows = d.theta_h / every * (d.theta_d / every), width = d.phi_d / every;
	float *table = malloc((size_t)rows * width * sizeof *table), *piece = malloc(SPECTRUM_BLOCK * 1024 * sizeof *piece);
	struct spectrum_inverse *inverse = NULL;
	struct spectrum_rows *t = NULL;
	uint32_t start[64];
	assert_int_equal(spectrum_inverse_create(d, &inverse, NULL), BP_OK);
	assert_int_equal(spectrum_rows_create(inverse, limit, d.phi_d, half, &t, NULL), BP_OK);
	struct spectrum_term *terms = terms_of(inverse, spectrum, start);
	assert_int_equal(spectrum_rows_field(t, 0, terms, start, NULL), BP_OK);
	for (uint32_t r = 0; r < rows; r += SPECTRUM_BLOCK) {
		const uint32_t count = rows - r < SPECTRUM_BLOCK ? rows - r : SPECTRUM_BLOCK;
		spectrum_rows_cells(t, 0, r, count, piece, 1024);
		for (uint32_t n = 0; n < count; n++) {
			uint32_t first, seen;
			spectrum_rows_seen(t, r + n, &first, &seen);
			assert_true(seen && first + seen <= width);
			for (uint32_t k = 0; k < width; k++) {
				const uint32_t inside = k < first ? first : k < first + seen ? k : first + seen - 1;
				assert_true(piece[n * 1024 + k] == piece[n * 1024 + inside]);
			}
			memcpy(table + (size_t)(r + n) * width, piece + n * 1024, width * sizeof *table);
		}
	}
	free(terms);
	free(piece);
	spectrum_rows_free(t);
	free(inverse);
	return table;
}

#endif
