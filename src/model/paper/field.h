/* field.h: one 2-D field of the paper's model from its sparse wavelet coefficients to its values. */
#ifndef MODEL_PAPER_FIELD_H
#define MODEL_PAPER_FIELD_H

#include "paper.h"

/*
 * Values stay within these. A pair copula is nowhere 0, so that no cell of a slice is lost to it; a conditional one may be.
 */
#define FIELD_VALUE_MAX 1e6f
#define FIELD_PAIR_MIN 0.03125f

struct field_codec; /* memory for fields of one kind; use it from one thread at a time; freed with free() */

bp_status field_codec_create(struct lattice_dims dims, enum paper_field kind, struct field_codec **out, bp_error *error);

/* The field's values, row-major, within their limits; all 1 when count is 0. Indices beyond the plane are ignored. */
void field_expand(struct field_codec *codec, const struct sparse_field *field, float *value);

#endif
