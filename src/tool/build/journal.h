/*
 * journal.h: the finished records of a build, beside its output, until the archive is written: a build that was killed or
 * interrupted loses none of them, and `build --update` goes on from there.
 *
 * The file is called `.brdfpack-CRC32-journal`, the CRC32 of the output's name. It belongs to whoever holds its lock; what is
 * there under that name and is no journal is never touched, and the records then go to a nameless scratch file.
 *
 *     header (JOURNAL_HEADER_BYTES): magic, version, options and codec version of the fit, the output's name, CRC32
 *     entries: mark, record's bytes, CRC32 of these bytes and of the record, record
 *
 * Little-endian. Whole entries count up to the first that is not: what a kill or a power cut tore is dropped. A record is
 * used only for a measured file of the size and SHA-256 that stand in its head.
 */
#ifndef TOOL_BUILD_JOURNAL_H
#define TOOL_BUILD_JOURNAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "codec/record.h"

#define JOURNAL_MAGIC \
	"\x8b" \
	"BPJ\r\n\x1a\n"
#define JOURNAL_MARK \
	"\x8b" \
	"JRN"
enum {
	JOURNAL_MAGIC_BYTES = 8,
	JOURNAL_VERSION = 1,
	JOURNAL_HEADER_BYTES = 300,
	JOURNAL_ENTRY_BYTES = 12,
	JOURNAL_REMARK_BYTES = 400
};

struct journal_entry {
	char *name;
	uint64_t offset; /* of the record */
	uint32_t bytes;
};

struct journal {
	int fd;                      /* -1: closed */
	char *path;                  /* NULL: a scratch file that has no name */
	uint64_t bytes;              /* of the file, as far as it is whole */
	struct journal_entry *found; /* what an interrupted build left; by name, of the same name the latest last */
	size_t found_count;
	size_t added; /* records that came since */
};

/*
 * Opens the journal of this output, or makes one. With `resume` the records that are there are taken over where they were made
 * with these options; else it begins anew. What is odd about that (another build runs, a file in the way, ...) stands in
 * `remark`, which is empty where nothing is. Errors (the folder is missing, not writable ...) carry the system's reason.
 */
bp_status journal_open(const char *output, const struct fit_options *options, bool resume, struct journal *out,
                       char remark[JOURNAL_REMARK_BYTES], bp_error *error);

/* Appends; *offset is where the record begins. */
bp_status journal_add(struct journal *journal, const uint8_t *record, size_t record_bytes, uint64_t *offset, bp_error *error);

/* Reads a record back, and checks its CRC32. BP_ERROR_IO also where that differs. */
bp_status journal_read(const struct journal *journal, uint64_t offset, uint8_t *record, uint32_t record_bytes, bp_error *error);

/* The latest of this name that was found; NULL: none. */
const struct journal_entry *journal_find(const struct journal *journal, const char *name);

/*
 * The found record of this name, if it was made from this source with these options by this program's codec; *record is
 * malloc'ed, or NULL where it has to be made anew. For workers.
 */
bp_status journal_take(const struct journal *journal, const char *name, const struct record_source *source,
                       const struct fit_options *options, uint8_t **record, size_t *record_bytes, bp_error *error);

/* Whether the open file still has this name. */
bool journal_has_name(int fd, const char *path);

/* Records that are kept for a next build when the journal is closed now with `keep`. */
size_t journal_count(const struct journal *journal);

/* Closes it; without `keep`, or where it holds no record, the file is removed. Allowed on one that was not opened, with fd -1. */
void journal_close(struct journal *journal, bool keep);

#endif
