/*
 * spectral_terms.h: the coefficients of a decoded model as lists of those that are not 0, ready for the inverse transform.
 */
#ifndef MODEL_SPECTRAL_SPECTRAL_TERMS_H
#define MODEL_SPECTRAL_SPECTRAL_TERMS_H

#include "spectral.h"
#include "spectrum_inverse.h"

struct spectral_terms {
	struct spectrum_term *term;
	uint32_t *start; /* start[f P + m]: of field f, harmonic m; 3 P + 1 of them */
};

/* What the first `layers` layers hold. Free it also after a failure. */
bp_status spectral_terms_make(const struct spectral_model *model, const struct spectrum_inverse *inverse, uint32_t layers,
                              struct spectral_terms *out, bp_error *error);
void spectral_terms_free(struct spectral_terms *terms);

#endif
