/*
 * manifest.h: lists of materials.
 *
 * A manifest is a text file, one material per line. A line that begins with # and empty lines
 * are skipped; a line ends with LF or CR LF. Either every line is just a name, or columns are
 * separated by tabs: then the first line may name them (`name` must be among them; `bytes` and
 * `sha256` are used when they are there, others are ignored), and without such a line they are
 * name, bytes, sha256 in this order. An empty column says nothing about the material. A name may be written as its measured
 * file's, NAME.binary or FOLDER/NAME.binary, as `ls` and `find` print it. A byte order mark at the beginning is passed over.
 */
#ifndef TOOL_BUILD_MANIFEST_H
#define TOOL_BUILD_MANIFEST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "brdfpack.h"
#include "merl/normal_form.h"

enum { MANIFEST_FILE_BYTES_MAX = 256 << 20 };

struct manifest_entry {
	char *name; /* without path and suffix; inside manifest.text */
	uint64_t bytes;
	uint8_t sha256[32];
	uint32_t line;
	bool has_bytes, has_sha256;
	bool found;      /* for the caller: set to report what is missing */
	bool other_form; /* manifest_note_unlisted was told of the same text in another Unicode form */
};

struct manifest {
	char *text;
	struct manifest_entry *entries; /* in ascending byte order of the name */
	size_t count;
	struct normal_forms forms; /* of the names, made when the first unlisted one is noted */
	bool forms_made;
};

/* Errors name the line. Names must be legal and differ. On success the caller frees with manifest_free. */
bp_status manifest_read(const char *path, struct manifest *out, bp_error *error);

/* The same from memory: text[bytes] is malloc'ed, with room for one byte more; it is taken over, also on failure. */
bp_status manifest_parse(char *text, size_t bytes, struct manifest *out, bp_error *error);

void manifest_free(struct manifest *manifest); /* a zeroed struct is allowed */

/* Notes that a material of this name is there and not listed: an entry may mean it. */
void manifest_note_unlisted(struct manifest *manifest, const char *name);

struct manifest_entry *manifest_find(const struct manifest *manifest, const char *name); /* NULL when it is not there */

/* BP_ERROR_BAD_INPUT with found and expected when the entry tells another size or SHA-256. */
bp_status manifest_check(const struct manifest_entry *entry, uint64_t bytes, const uint8_t sha256[32], bp_error *error);

#endif
