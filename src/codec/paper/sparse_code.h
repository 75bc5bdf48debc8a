/*
 * sparse_code.h: the coefficients of sparse fields as a range-coded stream (FORMAT.md, "Sparse fields").
 */
#ifndef CODEC_PAPER_SPARSE_CODE_H
#define CODEC_PAPER_SPARSE_CODE_H

#include "model/paper/paper.h"
#include "codec/range_coder.h"

enum { SPARSE_CONTEXTS = 8 };

/* Statistics that the fields of one section share. */
struct sparse_models {
	struct gamma_model gap[SPARSE_CONTEXTS], magnitude[SPARSE_CONTEXTS];
};

void sparse_models_reset(struct sparse_models *models);

void sparse_encode(struct range_encoder *encoder, struct sparse_models *models, const struct sparse_field *field);

/*
 * field->count and the two arrays are there; fills the arrays. BP_ERROR_CORRUPT when an index reaches
 * plane_cells or a level is beyond 16 bits.
 */
bp_status sparse_decode(struct range_decoder *decoder, struct sparse_models *models, uint32_t plane_cells,
                        struct sparse_field *field, bp_error *error);

#endif
