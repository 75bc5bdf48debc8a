/*
 * output_file.h: every file that is written: whole or not at all, and nothing lost by it. Internal.
 *
 * The bytes go to a new file in the same folder, which output_file_commit puts in its place. Where the system can (O_TMPFILE)
 * that file has no name until it is complete, so even SIGKILL leaves nothing behind; elsewhere, and for a moment before it
 * takes its place, it is called `.brdfpack-CRC32-PID-N`, the CRC32 of the name it will take: short, so that every legal name
 * can be written, and created exclusively, so that nobody's file is touched. A symbolic link at the path is followed: what it
 * points to is replaced, and keeps its mode, and its owner and group as far as that is allowed.
 */
#ifndef OUTPUT_FILE_H
#define OUTPUT_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/stat.h>

#include "brdfpack.h"

enum output_rule {
	OUTPUT_REPLACE, /* takes the place of a regular file that is there */
	OUTPUT_NEW,     /* refuses to take anything's place, also what appeared meanwhile */
	OUTPUT_COMPARE  /* writes nothing: fails unless the file that is there has just these bytes */
};

struct output_file {
	int fd;          /* -1: closed */
	char *target;    /* where it will appear, links resolved; malloc'ed */
	char *temporary; /* its name until then; NULL while it has none */
	enum output_rule rule;
	bool replaces;      /* a file was there when it was opened; */
	struct stat before; /* its mode and owner */
};

/*
 * Errors name `path`; then *out is closed. BP_ERROR_IO: no regular file can be there (a folder, a device, a dangling link, a
 * folder that is missing or not writable); BP_ERROR_ARGUMENT: by OUTPUT_NEW or OUTPUT_COMPARE, something is there.
 */
bp_status output_file_open(const char *path, enum output_rule rule, struct output_file *out, bp_error *error);

/* Appends all of the bytes, or compares them. */
bp_status output_file_write(struct output_file *out, const void *bytes, size_t count, bp_error *error);

/* Puts the file in its place and frees *out. On failure nothing is left, and an older file is as it was. */
bp_status output_file_commit(struct output_file *out, bp_error *error);

/*
 * The same, on the disk before it returns. Once the file is in its place this is no longer a failure: where its folder cannot be
 * synced, the message in *error says so, without the path, and the status is BP_OK; without a warning the message is empty.
 */
bp_status output_file_commit_synced(struct output_file *out, bp_error *error);

/* A file of just these bytes: all of the above. */
bp_status output_file_write_whole(const char *path, enum output_rule rule, const void *bytes, size_t count, bp_error *error);

/* Removes what was written, frees *out. Allowed after any other call, any number of times, and on a zeroed struct with fd -1. */
void output_file_discard(struct output_file *out);

/*
 * Removes what killed writers to the same path left where files must have a name: of our own making, as name, owner and first
 * bytes tell (OUTPUT_UNFINISHED, or the magic of a complete one), and of a process that lives no more, as its lock tells.
 */
#define OUTPUT_UNFINISHED "brdfpack: not complete\n"
void output_file_sweep(const char *path, const void *magic, size_t magic_bytes);

/* A scratch file without a name in the folder of the path, for reading and writing; it is gone when it is closed. */
bp_status output_scratch_open(const char *path, int *fd, bp_error *error);

#endif
