#include "items.h"

#include "error.h"
#include "memory.h"
#include "build_report.h"
#include "merl/merl_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bp_status items_add(struct items *items, const struct source_item *source, bool owned, bp_error *error)
{
	struct item *item = memory_grown(items->item, items->count, sizeof *item);
	if (!item) {
		if (owned)
			source_item_clear(&(struct source_item){source->name, source->path, source->member, 0, 0});
		return error_memory(error, items->count * sizeof *item);
	}
	items->item = item;
	items->item[items->count++] = (struct item){.source = *source, .owned = owned};
	return BP_OK;
}

uint64_t item_weight(const struct source_item *source)
{
	return source->bytes != UINT64_MAX ? source->bytes : merl_file_bytes(LATTICE_MERL);
}

static int item_compare(const void *a, const void *b)
{
	return strcmp(((const struct item *)a)->source.name, ((const struct item *)b)->source.name);
}

void items_sort(struct items *items)
{
	if (items->count > 0)
		qsort(items->item, items->count, sizeof *items->item, item_compare);
}

void items_free(struct items *items)
{
	for (size_t i = 0; i < items->count; i++) {
		if (items->item[i].owned)
			source_item_clear(&items->item[i].source);
		free(items->item[i].outcome);
	}
	free(items->item);
	*items = (struct items){0};
}

void item_label(const struct source_item *source, char label[ITEM_LABEL_BYTES])
{
	snprintf(label, ITEM_LABEL_BYTES, "%s%s%s", source->path, source->member ? ": " : "", source->member ? source->member : "");
}
