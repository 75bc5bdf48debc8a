/*
 * output_path.h: where a file is to appear, and what it is called until then. For output_file.h and the journal of a build.
 */
#ifndef OUTPUT_PATH_H
#define OUTPUT_PATH_H

#include <stdbool.h>
#include <sys/stat.h>

#include "brdfpack.h"

/*
 * Follows a link; *out is malloc'ed. Refuses (BP_ERROR_IO) what is no regular file. *found: a file is there, and *about what is
 * known of it.
 */
bp_status output_path_resolve(const char *path, char **out, bool *found, struct stat *about, bp_error *error);

/* A path in the target's folder, and the folder itself; malloc'ed, NULL without memory. */
char *output_path_beside(const char *target, const char *name);
char *output_path_folder(const char *target);

/* What the names of files begin with that will become the target. */
enum { OUTPUT_STEM_BYTES = 64 };
void output_path_stem(const char *target, char stem[OUTPUT_STEM_BYTES]);
/* Whether a path ends in such a name: nobody else's file. */
bool output_path_unfinished(const char *path);

/* Locks belong to the process, so they end with it and do not pass to forked workers. 0: the lock is ours. */
int output_path_lock(int fd);

#endif
