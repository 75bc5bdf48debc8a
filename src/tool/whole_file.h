/*
 * whole_file.h: a file as one text.
 */
#ifndef TOOL_WHOLE_FILE_H
#define TOOL_WHOLE_FILE_H

#include <stddef.h>

#include "brdfpack.h"

/* Reads a regular file of at most `most` bytes: *text is malloc'ed, with a NUL behind. BP_ERROR_LIMIT where it has more. */
bp_status whole_file_read(const char *path, size_t most, char **text, size_t *bytes, bp_error *error);

#endif
