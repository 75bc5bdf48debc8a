/* The public writer: gathers records in any order, then gives them to archive_writer in that of their names. */
#include <stdlib.h>
#include <string.h>

#include "codec/record.h"
#include "error.h"
#include "memory.h"
#include "writer.h"

struct gathered {
	char *name; /* in the same block, behind the record */
	uint8_t *record;
	size_t bytes;
};

struct bp_writer {
	struct gathered *list; /* in the order of the names */
	size_t count;
};

bp_status bp_writer_create(bp_writer **out, bp_error *error)
{
	if (!out)
		return error_argument(error, "a place for the writer is needed");
	bp_writer *writer = calloc(1, sizeof *writer);
	if (!writer)
		return error_memory(error, sizeof *writer);
	*out = writer;
	return BP_OK;
}

void bp_writer_free(bp_writer *writer)
{
	if (!writer)
		return;
	for (size_t n = 0; n < writer->count; n++)
		free(writer->list[n].record);
	free(writer->list);
	free(writer);
}

/* The first that is not before the name: strcmp goes by the bytes as unsigned, which is the archive's order. */
static size_t place_find(const bp_writer *writer, const char *name)
{
	size_t low = 0, high = writer->count;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (strcmp(writer->list[middle].name, name) < 0)
			low = middle + 1;
		else
			high = middle;
	}
	return low;
}

bp_status bp_writer_add(bp_writer *writer, const uint8_t *record, size_t record_bytes, bp_error *error)
{
	struct record_head head;
	if (!record)
		return error_argument(error, "there is no record");
	bp_status status = record_verify(record, record_bytes, &head, error);
	if (status)
		return status;
	const size_t place = place_find(writer, head.name), name_bytes = strlen(head.name) + 1;
	if (place < writer->count && !strcmp(writer->list[place].name, head.name))
		return error_argument(error, "there is a material \"%s\" already", head.name);
	struct gathered *list = memory_grown(writer->list, writer->count, sizeof *list);
	if (list)
		writer->list = list;
	uint8_t *copy = list ? malloc(record_bytes + name_bytes) : NULL;
	if (!copy)
		return error_memory(error, record_bytes + name_bytes);
	memcpy(copy, record, record_bytes);
	memcpy(copy + record_bytes, head.name, name_bytes);
	memmove(list + place + 1, list + place, (writer->count - place) * sizeof *list);
	list[place] = (struct gathered){.name = (char *)copy + record_bytes, .record = copy, .bytes = record_bytes};
	writer->count++;
	return BP_OK;
}

uint64_t bp_writer_count(const bp_writer *writer) { return writer->count; }

/* An archive writer that has all records; path NULL: in memory. */
static bp_status writer_fill(const bp_writer *writer, const char *path, struct archive_writer **out, bp_error *error)
{
	struct archive_writer *to = NULL;
	bp_status status = archive_writer_open(path, &to, error);
	for (size_t n = 0; !status && n < writer->count; n++)
		status = archive_writer_add(to, writer->list[n].record, writer->list[n].bytes, error);
	if (status)
		archive_writer_discard(to);
	*out = to;
	return status;
}

bp_status bp_writer_save(const bp_writer *writer, const char *path, bp_error *error)
{
	struct archive_writer *to;
	const bp_status status = writer_fill(writer, path ? path : "", &to, error);
	return status ? status : archive_writer_commit(to, error);
}

bp_status bp_writer_save_memory(const bp_writer *writer, uint8_t **bytes, size_t *count, bp_error *error)
{
	struct archive_writer *to;
	if (!bytes || !count)
		return error_argument(error, "places for the bytes and their number are needed");
	const bp_status status = writer_fill(writer, NULL, &to, error);
	return status ? status : archive_writer_commit_memory(to, bytes, count, error);
}
