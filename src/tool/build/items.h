/*
 * items.h: the materials of a build and what became of each so far.
 */
#ifndef TOOL_BUILD_ITEMS_H
#define TOOL_BUILD_ITEMS_H

#include "merl/source.h"

enum item_state { ITEM_WAITING, ITEM_PACKED, ITEM_REFUSED };

struct outcome; /* build_report.h */

struct item {
	struct source_item source; /* name, path, member */
	bool owned;                /* source's strings are freed with the item; otherwise they are the source list's */
	enum item_state state;
	uint32_t record_bytes;
	uint64_t journal_offset;
	struct outcome *outcome; /* from the result until it is reported, which happens in the items' order */
};

struct items {
	struct item *item;
	size_t count;
};

/* Appends; an owned source is taken over also on failure. */
bp_status items_add(struct items *items, const struct source_item *source, bool owned, bp_error *error);

/* Bytes of its file, for the progress bar; of a compressed one, which does not tell, those of most. */
uint64_t item_weight(const struct source_item *source);

void items_sort(struct items *items); /* by name, byte order */
void items_free(struct items *items); /* a zeroed struct is allowed */

/* "FILE" or "CONTAINER: MEMBER", for messages. */
enum { ITEM_LABEL_BYTES = 1024 };
void item_label(const struct source_item *source, char label[ITEM_LABEL_BYTES]);

#endif
