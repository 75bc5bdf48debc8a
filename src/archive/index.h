/*
 * index.h: the search tree at the end of an archive: pages of 4096 bytes, sorted by name.
 *
 * A leaf's entries point to records, an inner page's to pages one level below; both carry the
 * ordinal of the first material they lead to, so one path of pages finds a name or a number.
 */
#ifndef ARCHIVE_INDEX_H
#define ARCHIVE_INDEX_H

#include "bytes.h"
#include "format.h"

/* Where a record is. */
struct index_entry {
	uint64_t offset; /* in the file */
	uint32_t record_bytes, head_bytes;
	uint64_t ordinal; /* in name order, from 0 */
	uint32_t name_bytes;
	char name[256]; /* NUL-terminated */
};

/* Bytes of a page's entry before its name; the name's length is the last of them. */
static inline size_t index_fixed_bytes(uint32_t level) { return level ? 4 + 8 + 1 : 8 + 4 + 4 + 1; }

/* -- writing -- */

struct index_builder {
	struct byte_buffer entries; /* leaf entries as they come: bytes of a page without head; the owner frees it */
	uint64_t count;
};

/* Adds one record; names come in ascending order (the caller has checked). */
void index_add(struct index_builder *builder, const char *name, uint64_t offset, uint32_t record_bytes, uint32_t head_bytes);

/* Receives the pages in file order. */
typedef bp_status index_page_fn(void *user, const uint8_t page[PAGE_BYTES], bp_error *error);

/* Lays out all levels. *page_count and *depth are 0 when nothing was added. */
bp_status index_write(const struct index_builder *builder, index_page_fn *write, void *user, uint32_t *page_count,
                      uint32_t *depth, bp_error *error);

/* -- reading -- */

/* What is already known of a page before it is read: from its parent, or from the header for the root. */
struct page_expect {
	uint32_t number;
	uint32_t level; /* 0: leaf */
	uint64_t first_ordinal;
	const char *first_name; /* NULL: unknown (the root) */
	uint32_t first_name_bytes;
};

/*
 * One page, checked in full: CRC, magic, level, entry sizes, ascending legal names, ordinals, zero padding.
 * entry_at[i] is the offset of entry i's bytes in the page.
 */
struct index_page {
	uint32_t number, level, count;
	uint64_t first_ordinal;
	uint16_t entry_at[PAGE_ENTRIES_MAX + 1];
	uint8_t bytes[PAGE_BYTES];
};

/* Checks and parses page->bytes, filling the rest. Offsets in errors count from the page's start. */
bp_status index_page_read(struct index_page *page, const struct page_expect *expect, bp_error *error);

/* Entry i of a leaf. */
void index_leaf_entry(const struct index_page *leaf, uint32_t i, struct index_entry *out);

/* Child i of an inner page: what its page must be; the name stays in the page. */
struct page_expect index_child(const struct index_page *inner, uint32_t i);
uint64_t index_child_end(const struct index_page *inner, uint32_t i, uint64_t own_end); /* first ordinal behind child i */

/*
 * The entry whose subtree holds the name, or, name NULL, the ordinal (of an inner page): the last one that is not greater.
 * UINT32_MAX when all are greater.
 */
uint32_t index_search(const struct index_page *page, const char *name, uint64_t ordinal);

/* Name bytes of entry i, in the page. */
const char *index_entry_name(const struct index_page *page, uint32_t i, uint32_t *name_bytes);

#endif
