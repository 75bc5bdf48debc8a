/* paper_fields.h: the contents of the paper's sections. */
#ifndef CODEC_PAPER_PAPER_FIELDS_H
#define CODEC_PAPER_PAPER_FIELDS_H

#include "model/paper/paper.h"
#include "bytes.h"

void marginals_write(struct lattice_dims dims, const struct paper_channel *channel, struct byte_buffer *out);
/* specular: its product with the scale must be finite. Here as below the caller frees what the channel holds, also on failure. */
bp_status marginals_read(struct byte_reader *in, struct lattice_dims dims, double specular, struct paper_channel *channel,
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
