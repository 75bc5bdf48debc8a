/*
 * spool.h: a nameless scratch file for records that are finished before their turn. It lives in
 * the folder of the output, where there must be room for the records anyway, and is gone when
 * it is closed or the process dies, whatever kills it.
 */
#ifndef TOOL_BUILD_SPOOL_H
#define TOOL_BUILD_SPOOL_H

#include <stddef.h>
#include <stdint.h>

#include "brdfpack.h"

struct spool {
	int fd; /* -1: closed */
	uint64_t bytes;
};

/* Errors (the folder is missing, not writable ...) carry the system's reason. */
bp_status spool_open(const char *output_path, struct spool *out, bp_error *error);

/* Appends; *offset is where the bytes begin. */
bp_status spool_add(struct spool *spool, const uint8_t *bytes, size_t count, uint64_t *offset, bp_error *error);

bp_status spool_read(const struct spool *spool, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error);
void spool_close(struct spool *spool);

#endif
