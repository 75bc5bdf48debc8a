/*
 * spectrum_inverse.h: coefficients on their way back into tables (spectrum_rows.h), of which most are 0.
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
	float *gain;      /* of the spectrum's row theta_h * D + theta_d */
	float *harmonic;  /* a gain of each, besides: 1 */
	uint32_t place[]; /* of the row; behind it the arrays above */
};

/* *out is freed with free(). */
bp_status spectrum_inverse_create(struct lattice_dims dims, struct spectrum_inverse **out, bp_error *error);

/* The coefficient `value` in row theta_h * D + theta_d of the spectrum, of a harmonic. */
static inline struct spectrum_term spectrum_term_make(const struct spectrum_inverse *inverse, uint32_t row, uint32_t harmonic,
                                                      float value)
{
	return (struct spectrum_term){inverse->place[row], value * (inverse->gain[row] * inverse->harmonic[harmonic])};
}

#endif
