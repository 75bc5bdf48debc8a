/*
 * selection.h: which materials of an archive a command is about.
 */
#ifndef TOOL_SELECTION_H
#define TOOL_SELECTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "archive/reader.h"
#include "command.h"

/*
 * A material's name as people write it, as it is or as the measured file's, NAME.binary, FOLDER/NAME.binary: without path and
 * suffix. False: it is no legal name.
 */
bool selection_name_bare(const char *written, char name[BP_NAME_BYTES_MAX + 1]);

/* bp_archive_find for what `written` may mean, from the most literal on: the first that is there. BP_ERROR_NOT_FOUND: none is. */
bp_status selection_name_find(const bp_archive *archive, const char *written, uint64_t *index, bp_error *error);

/* An open archive and the materials that were asked for. */
struct selection {
	const char *path;
	bp_archive *archive;
	bool all;        /* every material, in name order */
	uint64_t *index; /* otherwise these, each once, in the order they were named */
	uint64_t count;
	bool incomplete;        /* some name was not there; that has been reported */
	struct index_page leaf; /* of the walk over all */
};

/*
 * Opens the archive and finds the names; no names: all materials. Reports what goes wrong. False
 * when the archive cannot be used at all. Names that are not there are reported with the nearest
 * spelling and left out. NAME.binary and FOLDER/NAME.binary mean NAME where there is nothing of that name itself.
 */
bool selection_open(struct selection *selection, const char *path, char **names, int name_count);
/* The same from operands ARCHIVE [NAME]...; an exit code. */
int selection_from(struct selection *selection, const struct command *command, char **operands, int operand_count);
/* Says that the archive has no such material, in which file it is named (or NULL), and which may have been meant. */
void selection_missing_report(const struct selection *selection, const char *written, const char *where);
void selection_close(struct selection *selection);

/* The index entry of the n-th selected material. A walk over all reads every index page once. */
bp_status selection_entry(struct selection *selection, uint64_t n, struct index_entry *entry, bp_error *error);

/*
 * The same with the record's head; reports what goes wrong, and is false then. Where the index itself fails, a walk over all
 * ends: `count` becomes n.
 */
bool selection_head(struct selection *selection, uint64_t n, struct index_entry *entry, struct record_head *head);

struct comparison_plans; /* render/comparison.h */
/* Plans for the first material whose head can be read, before a fork, so that the workers share their memory. */
bp_status selection_plans_make(struct selection *selection, struct comparison_plans *plans, bp_error *error);

#endif
