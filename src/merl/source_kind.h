/*
 * source_kind.h: what a file is taken for, and what its material is called. Part of the tool.
 */
#ifndef MERL_SOURCE_KIND_H
#define MERL_SOURCE_KIND_H

#include <stdbool.h>
#include <stddef.h>

enum source_kind {
	SOURCE_KIND_OTHER,
	SOURCE_KIND_MEASURED, /* a MERL file, or one of the RGL database */
	SOURCE_KIND_CONTAINER,
	SOURCE_KIND_FOREIGN /* a container that is not read */
};
enum { SOURCE_STEM_BYTES = 512 };

extern const char *const SOURCE_SUFFIXES[]; /* of measured files, as they are written; NULL ends them */

/* By the path's last part alone (for files found in folders); hidden files are SOURCE_KIND_OTHER. */
enum source_kind source_kind_by_name(const char *path);

/*
 * By the first bytes of a regular file that the user named. What is neither is taken for a measured
 * file, whose reader then says what is wrong; a container's suffix decides where the bytes do not.
 */
enum source_kind source_kind_by_content(const char *path);

/* Whether a file begins like one of the RGL database, whatever it is called. */
bool source_is_tensor_file(const char *path);

/* The material's name: the last part of the path less its suffix (two for x.binary.gz); cut where overlong, and then illegal. */
void source_stem(const char *path, char name[SOURCE_STEM_BYTES]);

/* Bytes of a name that are a measured file's suffix: ".binary", ".bsdf", ".binary.gz" and so on, in either case; 0: none. */
size_t source_suffix_bytes(const char *name);

#endif
