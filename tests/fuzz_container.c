/*
 * Tars and zips of arbitrary bytes, as `build` takes them: what is in them, then every item as a worker reads it and every member
 * of a stream as it comes.
 */
#include <stdlib.h>
#include <string.h>

#include "fuzz_file.h"
#include "merl/source.h"
#include "name.h"

enum { MEMBERS_MAX = 64 };
static const struct merl_reading READING = {.any_dims = true};

static void item_check(const struct source_item *item)
{
	if (name_fault(item->name, strlen(item->name)))
		abort();
}

static void items_read(const struct source_list *list)
{
	struct source_cursor cursor = {0};
	struct lattice lattice;
	for (size_t n = 0; n < list->item_count; n++) {
		item_check(&list->items[n]);
		if (n > 0 && strcmp(list->items[n - 1].name, list->items[n].name) >= 0)
			abort();
		if (n < MEMBERS_MAX && source_item_read(&list->items[n], &cursor, &READING, &lattice, NULL) == BP_OK)
			lattice_free(&lattice);
	}
	source_cursor_close(&cursor);
}

static void stream_read(struct source_list *list, size_t number)
{
	struct container *stream;
	struct source_item item = {0};
	struct lattice lattice;
	if (container_open(list->streams[number].path, CONTAINER_SEQUENTIAL, NULL, &stream, NULL) != BP_OK)
		return;
	for (int n = 0; n < MEMBERS_MAX; n++) {
		bool more = false;
		const bp_status status = source_stream_next(list, number, stream, &item, &more, NULL);
		if (status == BP_OK && !more)
			break;
		if (status == BP_OK) {
			item_check(&item);
			if (lattice_read(container_read, stream, &READING, &lattice, NULL) == BP_OK)
				lattice_free(&lattice);
		}
		source_item_clear(&item); /* of what is refused too */
	}
	container_close(stream);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	const char *path = fuzz_file(data, count);
	const struct source_options options = {0};
	struct source_list list;
	if (source_scan(&path, 1, &options, &list, NULL) != BP_OK)
		return 0;
	items_read(&list);
	for (size_t n = 0; n < list.stream_count; n++)
		stream_read(&list, n);
	source_list_free(&list);
	return 0;
}
