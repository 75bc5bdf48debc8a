#include "items.h"

#include "../codec/name.h"
#include "../error.h"

#include <stdlib.h>
#include <string.h>

/* FNV-1a, 64 bits. */
static uint64_t name_hash(const char *name)
{
	uint64_t hash = 14695981039346656037u;
	for (; *name; name++)
		hash = (hash ^ (unsigned char)*name) * 1099511628211u;
	return hash;
}

/* The slot that holds the name, or the empty one where it belongs. */
static uint32_t *slot_find(const struct items *items, const char *name)
{
	size_t at = name_hash(name) & (items->slot_count - 1);
	while (items->slots[at] && strcmp(items->item[items->slots[at] - 1].name, name) != 0)
		at = (at + 1) & (items->slot_count - 1);
	return &items->slots[at];
}

static void slots_fill(struct items *items)
{
	memset(items->slots, 0, items->slot_count * sizeof *items->slots);
	for (size_t i = 0; i < items->count; i++)
		*slot_find(items, items->item[i].name) = (uint32_t)i + 1;
}

/* Room for one more item, and a table that is at most half full. */
static bp_status items_grow(struct items *items, bp_error *error)
{
	if (items->count < items->room)
		return BP_OK;
	size_t room = items->room ? 2 * items->room : 128;
	if (room > UINT32_MAX / 2)
		return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "more than %zu materials", items->room);
	struct item *item = realloc(items->item, room * sizeof *item);
	if (!item)
		return error_memory(error, room * sizeof *item);
	items->item = item;
	uint32_t *slots = realloc(items->slots, 2 * room * sizeof *slots);
	if (!slots)
		return error_memory(error, 2 * room * sizeof *slots);
	items->slots = slots;
	items->slot_count = 2 * room;
	items->room = room;
	slots_fill(items);
	return BP_OK;
}

bp_status items_add(struct items *items, const char *name, const char *path, uint64_t source_bytes, bp_error *error)
{
	const char *fault = name_fault(name, strlen(name));
	if (fault)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "illegal name '%.200s': %s; rename the file", name, fault);
	bp_status status = items_grow(items, error);
	if (status)
		return status;
	uint32_t *slot = slot_find(items, name);
	if (*slot)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "the name '%.100s' is taken by %.200s; rename one of the two", name,
		                 items->item[*slot - 1].path);
	struct item item = {.name = strdup(name), .path = strdup(path), .source_bytes = source_bytes};
	if (!item.name || !item.path) {
		free(item.name);
		free(item.path);
		return error_memory(error, strlen(name) + strlen(path));
	}
	items->item[items->count++] = item;
	*slot = (uint32_t)items->count;
	return BP_OK;
}

static int item_compare(const void *a, const void *b)
{
	return strcmp(((const struct item *)a)->name, ((const struct item *)b)->name);
}

void items_sort(struct items *items)
{
	if (items->count == 0)
		return;
	qsort(items->item, items->count, sizeof *items->item, item_compare);
	slots_fill(items);
}

void items_free(struct items *items)
{
	for (size_t i = 0; i < items->count; i++) {
		free(items->item[i].name);
		free(items->item[i].path);
		free(items->item[i].outcome);
	}
	free(items->item);
	free(items->slots);
	*items = (struct items){0};
}
