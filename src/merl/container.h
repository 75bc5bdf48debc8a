/*
 * container.h: measured files inside a tar or zip, plain or compressed, read through libarchive
 * without unpacking. Part of the tool, not of the library.
 *
 * Members that count are named *.binary or *.bsdf (in either case), or like a container, and not hidden ("._x.binary" is
 * no table); others are passed over and counted. Of these, what is no file with bytes of its own (a link, a device), encrypted,
 * or a container itself has a fault. Tars that were joined, one behind the other, are read as one. A single compressed MERL file
 * (x.binary.gz) is a container of one member. Messages name the member but not the container: the caller puts that in front.
 */
#ifndef MERL_CONTAINER_H
#define MERL_CONTAINER_H

#include <stdbool.h>

#include "licence.h"
#include "merl_file.h"

struct container;

struct container_member {
	const char *path;  /* inside the container, as stored; valid until the next call */
	uint32_t ordinal;  /* among all entries of the container, from 0 */
	uint64_t bytes;    /* UINT64_MAX where the format does not say */
	const char *fault; /* why it cannot be packed, with the remedy; NULL: nothing is known against it. As long as the path */
};

enum container_order {
	CONTAINER_INDEXED,   /* passing over a member costs next to nothing: a plain tar, a zip with its central directory */
	CONTAINER_SEQUENTIAL /* anything: each byte before a member has to be read and unpacked */
};

/*
 * Opens a regular file. BP_ERROR_UNSUPPORTED: not a container that can be read in that order (try
 * CONTAINER_SEQUENTIAL after CONTAINER_INDEXED); BP_ERROR_BAD_INPUT: damaged, or no container at all, and what it is then;
 * BP_ERROR_IO. charset: of members' names that do not say that they are UTF-8, as iconv calls it; NULL: none is known, and such
 * names stay as they are.
 */
bp_status container_open(const char *path, enum container_order order, const char *charset, struct container **out,
                         bp_error *error);

/*
 * Moves on to the next member that counts; *more = false at the end. Errors (BP_ERROR_BAD_INPUT:
 * damaged) concern one member: call again to go on; where that is not
 * possible, the next call finds the end.
 */
bp_status container_next(struct container *container, struct container_member *member, bool *more, bp_error *error);

/*
 * Moves on to the member of that ordinal, which must lie ahead of, or be, the current one (unread).
 * BP_ERROR_NOT_FOUND when the container ends before.
 */
bp_status container_seek(struct container *container, uint32_t ordinal, bp_error *error);
/* Whether container_seek can still reach the ordinal. */
bool container_ahead(const struct container *container, uint32_t ordinal);

/* A merl_read_fn for the current member; user is the struct container. */
bp_status container_read(void *container, void *bytes, size_t capacity, size_t *read, bp_error *error);

/* What has been met so far. */
struct container_sums {
	size_t members;           /* those that counted */
	size_t ignored;           /* passed over because they are no measured files; folders do not count */
	struct licences licences; /* of these, texts of licences */
	const char *remark;       /* what is wrong with the whole although its members can be read, known at its end; NULL: nothing */
};
const struct container_sums *container_sums(const struct container *container);

void container_close(struct container *container); /* NULL is allowed */

#endif
