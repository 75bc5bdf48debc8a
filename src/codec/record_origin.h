/*
 * record_origin.h: the optional section that says what kind of file a material was read from, where that was no plain MERL table.
 */
#ifndef CODEC_RECORD_ORIGIN_H
#define CODEC_RECORD_ORIGIN_H

#include "section.h"

enum { ORIGIN_CODEC = 0, ORIGIN_VERSION = 1, ORIGIN_BYTES = 28 };

/* What the section adds to a record, its line in the head included; 0 for a MERL table, which has none. */
uint32_t record_origin_bytes(const struct origin *origin);

/* Puts the section before all others, into layer 0; nothing for a MERL table. False: too many sections, or no memory. */
bool record_origin_add(struct section_list *list, const struct origin *origin);

/* The section, or NULL where the record has none that this program understands. */
const struct record_section *record_origin_find(const struct record_head *head);

/* Whether a program that reads the source anew would write the same: no section of another version is there. */
bool record_origin_is_current(const struct record_head *head);

/* Its ORIGIN_BYTES bytes, whose checksum was found right. BP_ERROR_CORRUPT: an unknown kind, or a figure that is none. */
bp_status record_origin_parse(const uint8_t bytes[ORIGIN_BYTES], struct origin *out, bp_error *error);

#endif
