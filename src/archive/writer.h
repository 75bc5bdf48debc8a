/*
 * writer.h: records -> archive file. The archive appears under its name only when it is whole.
 *
 * The bytes go to a temporary file in the target's folder, `.NAME.PID-N.partial`, locked by its writer.
 * A writer that was killed leaves such a file behind; the next writer to the same target removes it
 * (it tells by the lock, which dies with its process).
 */
#ifndef ARCHIVE_WRITER_H
#define ARCHIVE_WRITER_H

#include "brdfpack.h"

struct archive_writer;

/*
 * Creates the temporary file beside `path`; its own path is in archive_writer_temporary (for clean-up on a
 * signal). A symbolic link at `path` is followed; anything there but a regular file is refused.
 */
bp_status archive_writer_open(const char *path, struct archive_writer **out, bp_error *error);
/* The same into memory: nothing of a file system is touched. */
bp_status archive_writer_open_memory(struct archive_writer **out, bp_error *error);
const char *archive_writer_temporary(const struct archive_writer *writer);

/* Appends one whole record, whose head is checked. Names must come in strictly ascending byte order. */
bp_status archive_writer_add(struct archive_writer *writer, const uint8_t *record, size_t record_bytes, bp_error *error);

/* Writes index and header, fsyncs, renames over `path`, fsyncs the folder; frees the writer, also on failure (then the temporary file is removed). */
bp_status archive_writer_commit(struct archive_writer *writer, bp_error *error);

/* The same for one in memory: *bytes is malloc'ed, the caller's. */
bp_status archive_writer_commit_memory(struct archive_writer *writer, uint8_t **bytes, size_t *count, bp_error *error);

/* Removes the temporary file and frees the writer; NULL is allowed. */
void archive_writer_discard(struct archive_writer *writer);

#endif
