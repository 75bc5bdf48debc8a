/*
 * field.h: one 2-D field of the paper's model between its values and its sparse wavelet coefficients.
 *
 * A field's plane (wavelet.h) is larger than the field. Its undefined cells and those outside the field are
 * filled smoothly around the torus (fill.h), then drawn towards what the kept coefficients say there, so that
 * no coefficient is spent on cells that do not count.
 */
#ifndef MODEL_PAPER_FIELD_H
#define MODEL_PAPER_FIELD_H

#include "paper.h"
#include "wavelet.h"

struct field_codec; /* memory for fields of one size and wavelet; use it from one thread at a time */

bp_status field_codec_create(enum wavelet kind, uint32_t rows, uint32_t columns, struct field_codec **out, bp_error *error);
void field_codec_free(struct field_codec *codec); /* NULL is allowed */

/*
 * Keeps the `keep` largest coefficients of value[rows * columns] where defined, quantised to at most 16 bits with a
 * step of their largest/32767; levels that round to 0 are dropped. The field is left out (count = 0) when it is
 * nowhere defined, or 1 within `tolerance` (rms over defined cells). The caller owns out's arrays.
 */
bp_status field_fit(struct field_codec *codec, const double *value, const uint8_t *defined, uint32_t keep, double tolerance,
                    struct sparse_field *out, bp_error *error);

enum { FIELD_VALUE_MAX = 1000000 };
/* The field's values, row-major, clamped to 0..FIELD_VALUE_MAX; all 1 when count is 0. Indices beyond the plane are ignored. */
void field_expand(struct field_codec *codec, const struct sparse_field *field, float *value);

#endif
