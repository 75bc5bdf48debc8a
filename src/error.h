/*
 * error.h: filling the caller's bp_error. Internal.
 *
 * Every function that can fail takes a bp_error as its last parameter (NULL is
 * allowed) and returns the status it stored there, so a failure reads
 *
 *     return error_set(error, BP_ERROR_CORRUPT, offset, "page %u: ...", page);
 */
#ifndef ERROR_H
#define ERROR_H

#include <stdint.h>

#include "brdfpack.h"

/* Stores status, byte offset (BP_NO_OFFSET where there is none) and the formatted message; returns status. */
bp_status error_set(bp_error *error, bp_status status, uint64_t offset, const char *format, ...)
	__attribute__((format(printf, 4, 5)));

/* The same for what a caller has got wrong, which is at no place of a file. */
#define error_argument(error, ...) error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, __VA_ARGS__)

/* An offset within a part becomes one within what the part begins at `base` of; returns status. */
bp_status error_shift(bp_status status, uint64_t base, bp_error *error);

/* The message of a failed allocation of `bytes`; returns BP_ERROR_MEMORY. */
bp_status error_memory(bp_error *error, size_t bytes);

#endif
