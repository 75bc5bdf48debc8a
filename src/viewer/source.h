/*
 * source.h: an archive read through a callback.
 *
 * A stand-in: the library's own bp_archive_open_source takes its place as soon as brdfpack.h has it; then this header and source.c go.
 */
#ifndef VIEWER_SOURCE_H
#define VIEWER_SOURCE_H

#include "brdfpack.h"

typedef int bp_read_fn(void *user, uint64_t offset, void *bytes, size_t count);

typedef struct bp_source {
	size_t struct_bytes;
	bp_read_fn *read;
	void (*close)(void *user);
	void *user;
	uint64_t bytes;
} bp_source;

bp_status bp_archive_open_source(const bp_source *source, bp_archive **out, bp_error *error);

#endif
