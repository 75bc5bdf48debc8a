/*
 * writer.h: records -> archive file. The archive appears under its name only when it is whole.
 *
 * The bytes go to a file of another name or none in the target's folder (output_file.h). Where it must have a name, a writer
 * that was killed leaves it behind, and the next writer to the same target removes it.
 */
#ifndef ARCHIVE_WRITER_H
#define ARCHIVE_WRITER_H

#include "brdfpack.h"

struct archive_writer;

/*
 * A symbolic link at `path` is followed; anything there but a regular file is refused. NULL: into memory, nothing of a file
 * system is touched.
 */
bp_status archive_writer_open(const char *path, struct archive_writer **out, bp_error *error);

/* Appends one whole record, whose head is checked. Names must come in strictly ascending byte order. */
bp_status archive_writer_add(struct archive_writer *writer, const uint8_t *record, size_t record_bytes, bp_error *error);

/*
 * Writes index and header, syncs, takes the place of what was at `path`; frees the writer, also on failure (then the old file is
 * as it was). BP_OK with a message in *error: the archive is in its place, and something was odd then
 * (output_file_commit_synced).
 */
bp_status archive_writer_commit(struct archive_writer *writer, bp_error *error);

/* The same for one in memory: *bytes is malloc'ed, the caller's. */
bp_status archive_writer_commit_memory(struct archive_writer *writer, uint8_t **bytes, size_t *count, bp_error *error);

/* Removes what was written and frees the writer; NULL is allowed. */
void archive_writer_discard(struct archive_writer *writer);

#endif
