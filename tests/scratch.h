/*
 * scratch.h: where a test keeps its files: in TMPDIR, or /tmp where that is not set, as tests/cli/run does.
 */
#ifndef TESTS_SCRATCH_H
#define TESTS_SCRATCH_H

#include <dirent.h>
#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { SCRATCH_BYTES = 256 }; /* of a path, with its NUL: a longer TMPDIR is refused */

static inline const char *scratch_parent(void)
{
	const char *parent = getenv("TMPDIR");
	return parent && *parent ? parent : "/tmp";
}

static inline int scratch_name(char path[SCRATCH_BYTES])
{
	const int length = snprintf(path, SCRATCH_BYTES, "%s/brdfpack-test.XXXXXX", scratch_parent());
	errno = ENAMETOOLONG;
	return length < SCRATCH_BYTES ? 0 : -1;
}

/* A new folder, empty. 0, or -1 with errno, as of mkdtemp. */
static inline int scratch_folder(char path[SCRATCH_BYTES]) { return scratch_name(path) || !mkdtemp(path) ? -1 : 0; }

/* A new file, empty. 0, or -1 with errno, as of mkstemp. */
static inline int scratch_file(char path[SCRATCH_BYTES])
{
	const int fd = scratch_name(path) ? -1 : mkstemp(path);
	return fd < 0 ? -1 : close(fd);
}

/* The path of a name in a folder; the last eight stay valid. */
static inline const char *scratch_in(const char *folder, const char *name)
{
	static char paths[8][2 * SCRATCH_BYTES];
	static int turn;
	turn = (turn + 1) % 8;
	return snprintf(paths[turn], sizeof *paths, "%s/%s", folder, name) < (int)sizeof *paths ? paths[turn] : NULL;
}

/* How many files and folders are in a folder; -1 where it cannot be read. */
static inline int scratch_count(const char *folder)
{
	int count = -2; /* . and .. */
	DIR *dir = opendir(folder);
	if (!dir)
		return -1;
	while (readdir(dir))
		count++;
	closedir(dir);
	return count;
}

static inline int scratch_remove_one(const char *path, const struct stat *about, int kind, struct FTW *place)
{
	(void)about, (void)kind, (void)place;
	return remove(path);
}

/* Removes a folder and all that is in it. 0, or -1 with errno. */
static inline int scratch_remove(const char *folder) { return nftw(folder, scratch_remove_one, 16, FTW_DEPTH | FTW_PHYS); }

#endif
