/*
 * material.h: one material named on the command line, whichever way: ARCHIVE NAME or MERL-FILE.
 */
#ifndef TOOL_MATERIAL_H
#define TOOL_MATERIAL_H

#include "archive/reader.h"
#include "command.h"
#include "render/lookup.h"

struct material {
	const char *path;
	char name[RECORD_NAME_BYTES_MAX + 1];
	bool measured; /* from a MERL file: lattice is there; otherwise head and table are */
	struct lattice lattice;
	struct record_head head;
	struct expansion table; /* of all layers */
};

/*
 * Opens operands[0]. An archive needs the name of a material in operands[1]; for a MERL file (of any legal
 * lattice) the name may be left out, and is only what the material is called. Reports what goes wrong, with the
 * nearest spelling of a name that is not there. Returns an exit code; after EXIT_OK the caller frees *material.
 */
int material_load(const struct command *command, char **operands, int operand_count, struct material *material);
void material_free(struct material *material); /* a zeroed struct is allowed */

/* 1 where a cell of a decoded table counts: all but those that extraction writes as negative. malloc'ed; the caller frees it. */
bp_status material_counting_cells(const struct record_head *head, uint8_t **valid, bp_error *error);
/* A decoded table to render from: cells that do not count are black. */
bp_status material_lookup(const struct record_head *head, const struct expansion *decoded, struct lookup_table *out,
                          bp_error *error);

#endif
