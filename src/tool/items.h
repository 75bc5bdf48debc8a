/*
 * items.h: what a build packs: one item per material, from whichever input it comes, and the
 * set of their names.
 */
#ifndef TOOL_ITEMS_H
#define TOOL_ITEMS_H

#include <stddef.h>
#include <stdint.h>

#include "../brdfpack.h"

enum item_state { ITEM_WAITING, ITEM_PACKED, ITEM_REFUSED };

struct outcome; /* build_report.h */

struct item {
	char *name;
	char *path;             /* the file, or "STREAM: MEMBER"; for messages, and to open a plain file */
	uint64_t source_bytes;  /* for the progress bar; 0 where not known */
	enum item_state state;
	uint32_t record_bytes;
	uint64_t spool_offset;
	struct outcome *outcome; /* from the result until it is reported, which happens in the items' order */
};

struct items {
	struct item *item;
	size_t count, room;
	uint32_t *slots; /* hash table: index + 1 into item, 0 empty; slot_count is a power of two */
	size_t slot_count;
};

/*
 * Adds an item; the strings are copied. BP_ERROR_BAD_INPUT when the name is illegal or taken
 * (then both paths stand in the message).
 */
bp_status items_add(struct items *items, const char *name, const char *path, uint64_t source_bytes, bp_error *error);

void items_sort(struct items *items); /* by name, byte order */
void items_free(struct items *items); /* a zeroed struct is allowed */

#endif
