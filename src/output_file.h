/*
 * output_file.h: a file that appears under its name whole or not at all. Internal.
 *
 * The bytes go to a temporary file in the same folder, which output_file_commit renames over
 * `path`. Where the system can (O_TMPFILE), the temporary file has no name until it is
 * complete, so that even SIGKILL leaves nothing behind.
 */
#ifndef OUTPUT_FILE_H
#define OUTPUT_FILE_H

#include <stddef.h>

#include "brdfpack.h"

struct output_file {
	int fd;          /* open for writing; -1 when closed */
	char *path;      /* where it will appear */
	char *temporary; /* beside it, with a name while named is set */
	int named;
};

/* Creates the temporary file. Errors (BP_ERROR_IO) name `path`; then *out is closed. */
bp_status output_file_open(const char *path, struct output_file *out, bp_error *error);

/* Appends all of the bytes. */
bp_status output_file_write(struct output_file *out, const void *bytes, size_t count, bp_error *error);

/* Renames over the path and frees *out. On failure the temporary file is removed and an older file is as it was. */
bp_status output_file_commit(struct output_file *out, bp_error *error);

/* Removes what was written and frees *out. Allowed after every other call, any number of times. */
void output_file_discard(struct output_file *out);

#endif
