/*
 * spectrum_inverse.h: tables from spectra (spectrum.h) of which most coefficients are 0.
 *
 * The cosines along phi_d and the wavelets over (theta_h, theta_d) commute. Cosines first: every coefficient that is
 * not 0 adds its cosine to the cells of its row, a few hundred thousand multiply-adds for a block of cells where a product with
 * the cosine table takes hundreds of millions for the whole. Then the wavelets run on the block's plane,
 * which stays in the processor's cache.
 *
 * A plane is [theta_h][theta_d][SPECTRUM_BLOCK]. Its coefficients stand where the lifting steps want them and leave their
 * results: that of row i at step l of the wavelet in row 2^l i, so nothing is moved from step to step. The steps' gains are
 * products in the coefficients.
 */
#ifndef MODEL_SPECTRAL_SPECTRUM_INVERSE_H
#define MODEL_SPECTRAL_SPECTRUM_INVERSE_H

#include "spectrum.h"

enum { SPECTRUM_BLOCK = 16 }; /* one cache line of float */

/* A coefficient that is not 0. */
struct spectrum_term {
	uint32_t place; /* of its row in a plane */
	float value;    /* with its gain */
};

struct spectrum_inverse {
	struct lattice_dims dims;
	uint32_t levels;
	uint32_t *place; /* of the spectrum's row theta_h * D + theta_d */
	float *gain;
	float *harmonic; /* a gain of each, besides: 1 */
	float *cosine;   /* sqrt(2 / P) cos(pi a / 2 P), a = 0..4 P - 1 */
};

bp_status spectrum_inverse_create(struct lattice_dims dims, struct spectrum_inverse **out, bp_error *error);
void spectrum_inverse_free(struct spectrum_inverse *inverse); /* NULL is allowed */

/* The coefficient `value` in row theta_h * D + theta_d of the spectrum, of a harmonic. */
static inline struct spectrum_term spectrum_term_make(const struct spectrum_inverse *inverse, uint32_t row, uint32_t harmonic,
                                                      float value)
{
	return (struct spectrum_term){inverse->place[row], value * (inverse->gain[row] * inverse->harmonic[harmonic])};
}

/*
 * out[n] = s_m cos(pi m (k + 1/2) / P) of spectrum.h, for the `count` cells k = first, first + every, ...; the formula goes on
 * past the last cell.
 */
void spectrum_inverse_cosines(const struct spectrum_inverse *inverse, uint32_t harmonic, uint32_t first, uint32_t every,
                              uint32_t count, float *out);

/*
 * The cells first..first + SPECTRUM_BLOCK - 1 of all rows of phi_d, from the terms start[m]..start[m + 1] - 1 of every harmonic
 * m. The plane is aligned to a vector of 32 bytes; what lies past the last cell means nothing.
 */
void spectrum_inverse_block(const struct spectrum_inverse *inverse, const struct spectrum_term *terms, const uint32_t *start,
                            uint32_t first, float *plane);

#endif
