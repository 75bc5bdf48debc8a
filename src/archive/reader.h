/*
 * reader.h: what the tool and the library share behind the public handle bp_archive.
 *
 * The handle never changes after opening but for its count of bytes read, so all of these may be
 * called from several threads at once. Offsets in errors count from the file's start.
 */
#ifndef ARCHIVE_READER_H
#define ARCHIVE_READER_H

#include "codec/record.h"
#include "index.h"

/* Reads exactly count bytes at offset; a file that ends before is BP_ERROR_CORRUPT. */
bp_status archive_read(const struct bp_archive *archive, uint64_t offset, void *bytes, size_t count, bp_error *error);

const struct archive_header *archive_header(const struct bp_archive *archive);
const char *archive_path(const struct bp_archive *archive);

/* Reads and checks the page that is expected; *page is the caller's to keep. */
bp_status archive_page_read(const struct bp_archive *archive, const struct page_expect *expect, struct index_page *page,
                            bp_error *error);

/*
 * Entry `index` (0..count-1, in name order). *leaf is the caller's memory of the last leaf page: zero it
 * before the first call, and a walk over all materials reads every page once. NULL: for one call.
 */
bp_status archive_entry(const struct bp_archive *archive, uint64_t index, struct index_page *leaf, struct index_entry *entry,
                        bp_error *error);

/* Reads and checks the head of an entry's record: it must be the material that the index says. */
bp_status archive_entry_head(const struct bp_archive *archive, const struct index_entry *entry, struct record_head *head,
                             bp_error *error);

/* An entry's whole record: *record is malloc'ed, checksums of head and sections are checked. For who copies records. */
bp_status archive_entry_record(const struct bp_archive *archive, const struct index_entry *entry, struct record_head *head,
                               uint8_t **record, bp_error *error);

/*
 * What kind of file the material was read from, from the section that says so (codec/record_origin.h); ORIGIN_MERL where there is
 * none that this program understands.
 */
bp_status archive_entry_origin(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                               struct origin *out, bp_error *error);

/* Entry and head of material `index` (0..count-1, in name order). */
bp_status archive_record_head(const struct bp_archive *archive, uint64_t index, struct index_entry *entry,
                              struct record_head *head, bp_error *error);

/* Loads layers 0..layers-1 (0: all) of material `index`; reads the sections of these layers only. */
bp_status archive_model_load(const struct bp_archive *archive, uint64_t index, uint32_t layers, struct model **out,
                             bp_error *error);

/* The same when entry and head are known already. */
bp_status archive_entry_load(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                             uint32_t layers, struct model **out, bp_error *error);

/* That model's table: *table as model_expand has it, the caller's to free also after an error. */
bp_status archive_entry_expand(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                               uint32_t layers, struct expansion *table, bp_error *error);

#endif
