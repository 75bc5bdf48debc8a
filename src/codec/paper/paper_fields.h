/* paper_fields.h: the contents of the paper's sections. */
#ifndef CODEC_PAPER_PAPER_FIELDS_H
#define CODEC_PAPER_PAPER_FIELDS_H

#include "model/paper/paper.h"
#include "bytes.h"
#include "codec/range_coder.h"

void marginals_write(struct lattice_dims dims, const struct paper_channel *channel, struct byte_buffer *out);
/* specular: its product with the scale must be finite. Here as below the caller frees what the channel holds, also on failure. */
bp_status marginals_read(struct byte_reader *in, struct lattice_dims dims, double specular, struct paper_channel *channel,
                         bp_error *error);

/*
 * The coder of one section's fields (FORMAT.md, "Sparse fields"), which are of one kind and come one after the other. *out is
 * freed with free().
 */
struct sparse_coder;
bp_status sparse_coder_create(struct lattice_dims dims, enum paper_field kind, struct sparse_coder **out, bp_error *error);
/* A field whose count is not 0. */
void sparse_encode(struct range_encoder *encoder, struct sparse_coder *coder, const struct sparse_field *field);
/*
 * Fills count, index and level, which the caller frees also on failure. BP_ERROR_CORRUPT when there are more coefficients than
 * cells or than `most`, an index reaches the plane's end, or a level is beyond PAPER_LEVEL_MAX.
 */
bp_status sparse_decode(struct range_decoder *decoder, struct sparse_coder *coder, size_t most, struct sparse_field *field,
                        bp_error *error);

bp_status fields_write(struct lattice_dims dims, enum paper_field kind, const struct sparse_field *fields, uint32_t count,
                       struct byte_buffer *out, bp_error *error);
/* Reads `count` zeroed fields. */
bp_status fields_read(struct byte_reader *in, struct lattice_dims dims, enum paper_field kind, struct sparse_field *fields,
                      uint32_t count, bp_error *error);

/*
 * A copy with steps 2^(shift/256) times as large (a slice's; a pair's, which serves many slices, less), levels to match; those
 * that become 0 go, so the coefficients that gain least are the first to. A field that has none left is 1; at the largest shift
 * all are. *out is freed by sparse_fields_free.
 */
enum { SPARSE_SHIFT_MAX = 20 * 256 };
bp_status fields_coarsen(enum paper_field kind, const struct sparse_field *fields, uint32_t count, uint32_t shift,
                         struct sparse_field **out, bp_error *error);

#endif
