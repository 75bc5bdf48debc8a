/*
 * reader.h: what the tool and the library share behind the public handle bp_archive.
 */
#ifndef ARCHIVE_READER_H
#define ARCHIVE_READER_H

#include "../codec/record.h"

struct bp_archive; /* opened, counted and searched through brdfpack.h */

/* Reads and checks the head of material `index` (0..count-1, in name order). */
bp_status archive_record_head(struct bp_archive *archive, uint64_t index, struct record_head *head, bp_error *error);

/* Loads layers 0..layers-1 (0: all) of material `index`. */
bp_status archive_model_load(struct bp_archive *archive, uint64_t index, uint32_t layers, struct model **out, bp_error *error);

#endif
