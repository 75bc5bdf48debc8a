/*
 * format.h: the file around the records (format-spec/FORMAT.md, "Archive").
 *
 *     header (64 bytes) | records, in name order | index pages, leaves first, the root last
 *
 * Nothing stands between the parts: every byte belongs to one structure and is under its CRC32.
 */
#ifndef ARCHIVE_FORMAT_H
#define ARCHIVE_FORMAT_H

#include <stdint.h>

#include "brdfpack.h"

#define ARCHIVE_MAGIC \
	"\x8b" \
	"BPK\r\n\x1a\n"
#define PAGE_MAGIC \
	"\x8b" \
	"IDX"

enum {
	ARCHIVE_MAGIC_BYTES = 8,
	ARCHIVE_MAJOR = 1,
	ARCHIVE_MINOR = 0,
	ARCHIVE_HEADER_BYTES = 64,
	ARCHIVE_AT_FILE_BYTES = 16,      /* where the header tells the file's size */
	ARCHIVE_REQUIRED_FLAGS = 0xFFFF, /* bits that a reader must know; the upper half may be ignored */
	PAGE_BYTES = 4096,
	PAGE_HEAD_BYTES = 16,
	PAGE_ENTRIES_MAX = 255,
	LEAF_ENTRIES_MAX = 226, /* of names of one byte, 18 bytes each */
	INDEX_DEPTH_MAX = 8
};

/* Materials and pages that one archive may have. */
#define ARCHIVE_COUNT_MAX UINT64_C(100000000)
#define ARCHIVE_PAGES_MAX UINT64_C(16000000)

struct archive_header {
	uint64_t file_bytes;
	uint64_t count;        /* materials */
	uint64_t index_offset; /* of page 0 = the end of the last record */
	uint32_t page_count;   /* the root is the last page; 0 when count is 0 */
	uint32_t depth;        /* levels: 1 where the root is a leaf; 0 when count is 0 */
};

/* Of this version of the format, without flags. */
void archive_header_write(const struct archive_header *header, uint8_t bytes[ARCHIVE_HEADER_BYTES]);

/*
 * Checks and parses the first `count` bytes (up to 64) of a file of file_bytes. BP_ERROR_NOT_OURS without the magic,
 * BP_ERROR_CHECKSUM, BP_ERROR_UNSUPPORTED, or BP_ERROR_CORRUPT where sizes do not fit each other or the file.
 */
bp_status archive_header_read(const uint8_t *bytes, size_t count, uint64_t file_bytes, struct archive_header *out,
                              bp_error *error);

#endif
