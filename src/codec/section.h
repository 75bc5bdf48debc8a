/*
 * section.h: a record under construction: its sections' bytes and what the table will say of them.
 *
 * A profile's encoder adds sections in the order of their layers; sections_join puts the head before
 * them. FORMAT.md, "Record", has the layout.
 */
#ifndef CODEC_SECTION_H
#define CODEC_SECTION_H

#include "bytes.h"
#include "record.h"

struct section_list {
	uint32_t count;
	struct record_section entry[RECORD_SECTIONS_MAX]; /* offset, bytes and crc32 are sections_join's to fill */
	struct byte_buffer bytes[RECORD_SECTIONS_MAX];
};

/* A new section of this layer (not below the last one's); the caller writes into the buffer. NULL: there are too many. */
struct byte_buffer *section_add(struct section_list *list, enum section_type type, uint16_t codec, uint16_t version,
                                uint32_t layer, uint32_t flags, double error);
void section_list_free(struct section_list *list);

/*
 * Head and sections -> one record, malloc'ed. Of *head the caller has filled name, profile, codec_version, dims,
 * horizon_limit, colour, options, source, layer_count, the layers' fidelity and left_out; the rest is filled here.
 */
bp_status sections_join(struct record_head *head, const struct section_list *sections, uint8_t **record, size_t *record_bytes,
                        bp_error *error);

#endif
