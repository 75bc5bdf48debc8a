/*
 * sparse_code.h: the coefficients of sparse fields as a range-coded stream (FORMAT.md, "Sparse fields").
 */
#ifndef CODEC_PAPER_SPARSE_CODE_H
#define CODEC_PAPER_SPARSE_CODE_H

#include "model/paper/paper.h"
#include "codec/range_coder.h"

enum { SPARSE_GAPS = 8, SPARSE_BANDS = 12, SPARSE_BEFORE = 4 };

/* Statistics that the fields of one section share. */
struct sparse_models {
	struct gamma_model count, gap[SPARSE_GAPS], magnitude[SPARSE_BANDS][SPARSE_BEFORE];
};

/* The coder of one section: its fields are of one kind, and come one after the other. */
struct sparse_coder {
	struct sparse_models models;
	uint32_t cells;  /* of the plane */
	uint8_t *band;   /* [cells]: how fine the coefficients are, 0 coarse */
	uint8_t *before; /* [cells]: min(|level|, 3) of the field before; 0 at first */
	uint32_t mark_count;
	uint32_t marks[]; /* where it is not 0; behind them the arrays above */
};

/* *out is freed with free(). */
bp_status sparse_coder_create(struct lattice_dims dims, enum paper_field kind, struct sparse_coder **out, bp_error *error);

/* A field whose count is not 0. */
void sparse_encode(struct range_encoder *encoder, struct sparse_coder *coder, const struct sparse_field *field);

/*
 * Fills count, index and level, which the caller frees also on failure. BP_ERROR_CORRUPT when there are more coefficients than
 * cells or than `most`, an index reaches the plane's end, or a level is beyond PAPER_LEVEL_MAX.
 */
bp_status sparse_decode(struct range_decoder *decoder, struct sparse_coder *coder, size_t most, struct sparse_field *field,
                        bp_error *error);

#endif
