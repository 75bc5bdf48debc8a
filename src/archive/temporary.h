/*
 * temporary.h: the file an archive is written to before it takes its name.
 */
#ifndef ARCHIVE_TEMPORARY_H
#define ARCHIVE_TEMPORARY_H

#include "brdfpack.h"

struct temporary_file {
	char *target; /* the name it will take, links resolved; malloc'ed */
	char *path;   /* malloc'ed, in the target's folder */
	int fd;       /* -1: closed */
};

/* Removes what killed writers to the same target left behind, then creates and locks a new file. */
bp_status temporary_create(const char *target, struct temporary_file *out, bp_error *error);

/* fsync, close, rename, fsync of the folder. On failure the file is still there for temporary_discard. */
bp_status temporary_commit(struct temporary_file *file, bp_error *error);

/* Frees; also removes the file when it has not been committed. A zeroed struct with fd -1 is allowed. */
void temporary_discard(struct temporary_file *file);

#endif
