/*
 * measured.h: the materials of an archive beside their measured files, which are found by their names.
 */
#ifndef TOOL_MEASURED_H
#define TOOL_MEASURED_H

#include "merl/source.h"
#include "selection.h"

struct measured_item {
	struct index_entry entry;
	const struct source_item *source; /* its measured file; NULL: there is none, or none was sought */
};

struct measured_set {
	struct measured_item *item;
	const char **name; /* the items' */
	size_t count;
	struct source_list sources;
};

/*
 * The selected materials. Where the index fails *error says why, and the set has those before. A set of zeros, or that failed, is
 * freed too.
 */
bp_status measured_set_read(struct selection *selection, struct measured_set *out, bp_error *error);

/* Searches a folder (or zip) for their files. What is passed over has been said. */
bp_status measured_set_find(struct measured_set *set, const char *folder, bp_error *error);

void measured_set_free(struct measured_set *set);

/*
 * Reads a measured file, of any legal extents, as `build` did when it made the record: by the same rule for holes. *packed,
 * unless NULL, tells whether it is the very file that was packed, by its SHA-256. Messages begin with the path.
 */
bp_status measured_read(const struct source_item *source, struct source_cursor *cursor, const struct record_head *head,
                        struct lattice *out, bool *packed, bp_error *error);

#endif
