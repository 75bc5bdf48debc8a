/*
 * folder.h: output folders.
 */
#ifndef TOOL_FOLDER_H
#define TOOL_FOLDER_H

#include <stdbool.h>
#include <stdint.h>

#include "output_file.h"

/*
 * Files that a command writes into a folder under names that it does not choose. Names that exist are refused, all of them named
 * and before anything is written, unless their files hold just what would be written: these are left as they are. With `force`
 * files are replaced.
 */
struct folder_set {
	const char *folder, *suffix;
	uint64_t count;
	bool force;
	void *user;
	/* The n-th file's stem, valid until the next call; NULL where it cannot be told (writing it then says why). */
	const char *(*name)(void *user, uint64_t n);
	/* Writes (or compares, by the rule) the n-th file. */
	bp_status (*write)(void *user, uint64_t n, const char *path, enum output_rule rule, bp_error *error);
	/* Reports why the n-th file could not be written. */
	void (*failed)(void *user, uint64_t n, const bp_error *error);
};

/* Creates the folder and writes the files; true when all of them are there. Has said what is wrong. */
bool folder_write(const struct folder_set *set);

/* "FOLDER/NAME.SUFFIX", malloc'ed; NULL when memory ran out. */
char *folder_path(const char *folder, const char *name, const char *suffix);

#endif
