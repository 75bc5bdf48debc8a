/*
 * system.h: all that the reader wants of the system beyond standard C. Internal.
 *
 * With -DBP_PORTABLE it wants nothing: files through stdio, no huge pages, processor time of the whole process. An archive
 * that is open then may be read from one thread at a time, unless it lies in memory or comes through callbacks.
 */
#ifndef SYSTEM_H
#define SYSTEM_H

#include <stddef.h>
#include <stdint.h>

#include "brdfpack.h"

#if defined __GNUC__ && !defined __clang__ && __GNUC__ < 12
#error "brdfpack needs gcc 12 or clang 14, or newer: older ones of gcc have no __builtin_shufflevector"
#endif
#if defined __FLT_EVAL_METHOD__ && __FLT_EVAL_METHOD__ != 0
#error "brdfpack needs arithmetic in the precision of its operands: 32-bit x86 -msse2 -mfpmath=sse, s390x -fexcess-precision=fast"
#endif

struct system_file;

/* Opens a regular file for reading; messages do not name it. */
bp_status system_file_open(const char *path, struct system_file **out, uint64_t *bytes, bp_error *error);
/* Reads `count` bytes at `offset`, or as many as there are: *got. BP_ERROR_IO otherwise, with offset and the system's words. */
bp_status system_file_read(struct system_file *file, uint64_t offset, void *bytes, size_t count, size_t *got, bp_error *error);
/* Bytes that the file has now; `otherwise` where the system does not say. */
uint64_t system_file_bytes(struct system_file *file, uint64_t otherwise);
void system_file_close(struct system_file *file); /* NULL is allowed */

/* `bytes` bytes at a multiple of `alignment`, a power of two, for free(); NULL where there are none. */
void *system_alloc(size_t bytes, size_t alignment);

/* A hint that the pages from `start` on be huge ones. */
void system_prefer_huge(void *start, size_t bytes);

/* Processor seconds of the calling thread. */
double system_thread_seconds(void);

#endif
