/*
 * archive_walk.h: everything a renderer does with an archive, on archives that may be damaged; and checksums mended
 * after damage, so that what stands behind them is reached too.
 */
#ifndef TESTS_ARCHIVE_WALK_H
#define TESTS_ARCHIVE_WALK_H

#include "archive/recover.h"

enum { WALK_CELLS_MAX = 1 << 16 }; /* larger lattices are legal but slow: materials of more cells are not loaded */

/* The values of one material in a few directions. */
struct walk_values {
	char name[BP_NAME_BYTES_MAX + 1];
	float rgb[4][3];
	uint32_t extracted; /* CRC32 of the file that extraction writes; 0: not extracted */
};

/* What is done beside: */
enum {
	WALK_LIST = 1, /* every head is read and parsed, and all that `list` says of up to `most` materials printed */
	WALK_EXTRACT =
		2 /* each material that loads is written as a file that carries its record, as by `extract`, and copied by the public calls */
};

/*
 * Opens, verifies (which reads every record; deeply when all lattices are small and all materials wanted), finds and loads up to
 * `most` materials from `first` on, in one of the forms, and evaluates them; `also` says what else. Aborts when a value is
 * negative, NaN or infinite. Returns what verification said, or why it did not open. seen (may be NULL) receives up to `most`
 * materials, *seen_count of them.
 */
bp_status archive_walk(const char *path, uint64_t first, uint64_t most, unsigned also, struct walk_values *seen,
                       uint64_t *seen_count);
/*
 * What `recover` does, and a walk through what it saved, `most` materials from `first` on: *saved says how many and what was
 * lost. Aborts when the result does not verify, or holds another number of materials. BP_ERROR_* where nothing was saved.
 */
bp_status archive_rescue(const char *path, uint64_t first, uint64_t most, struct walk_values *seen, uint64_t *seen_count,
                         struct recovery *saved);

/* Mends the CRC32 of a record's sections and head, as far as the bytes are there. */
void record_mend(uint8_t *bytes, size_t count);
/* Mends size and CRC32 of the header, of the pages it names, and every record found by its magic. */
void archive_mend(uint8_t *bytes, size_t count);

#endif
