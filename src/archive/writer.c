#include "writer.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "name.h"
#include "codec/record.h"
#include "error.h"
#include "index.h"
#include "output_file.h"

enum { BUFFER_BYTES = 1 << 18 };

struct archive_writer {
	struct output_file file;
	bool in_memory;             /* there is no file */
	struct byte_buffer pending; /* not yet in the file; all of the archive where there is none */
	struct index_builder index;
	uint64_t file_bytes;                       /* written so far, pending ones included */
	char last_name[RECORD_NAME_BYTES_MAX + 1]; /* "" before the first record */
};

/* What is pending goes to the file, if that is as much as `least`. */
static bp_status pending_flush(struct archive_writer *writer, size_t least, bp_error *error)
{
	const size_t count = writer->pending.count;
	if (writer->pending.failed)
		return error_memory(error, count);
	if (writer->in_memory || count < least)
		return BP_OK;
	writer->pending.count = 0;
	return output_file_write(&writer->file, writer->pending.bytes, count, error);
}

static bp_status writer_append(struct archive_writer *writer, const uint8_t *bytes, size_t count, bp_error *error)
{
	write_bytes(&writer->pending, bytes, count);
	writer->file_bytes += count;
	return pending_flush(writer, BUFFER_BYTES, error);
}

bp_status archive_writer_open(const char *path, struct archive_writer **out, bp_error *error)
{
	static const uint8_t header_to_come[ARCHIVE_HEADER_BYTES] = OUTPUT_UNFINISHED;
	struct archive_writer *writer = calloc(1, sizeof *writer);
	bp_status status = BP_OK;
	if (!writer)
		return error_memory(error, sizeof *writer);
	writer->file.fd = -1;
	writer->in_memory = !path;
	if (path) {
		output_file_sweep(path, ARCHIVE_MAGIC, ARCHIVE_MAGIC_BYTES);
		status = output_file_open(path, OUTPUT_REPLACE, &writer->file, error);
	}
	if (!status)
		status = writer_append(writer, header_to_come, sizeof header_to_come, error);
	if (!status) /* at once, so that the next writer knows it for ours if this one is killed */
		status = pending_flush(writer, 0, error);
	if (status)
		archive_writer_discard(writer);
	else
		*out = writer;
	return status;
}

bp_status archive_writer_add(struct archive_writer *writer, const uint8_t *record, size_t record_bytes, bp_error *error)
{
	struct record_head head;
	bp_status status = record_head_read(record, record_bytes, &head, error);
	if (status)
		return status;
	if (head.record_bytes != record_bytes)
		return error_argument(error, "%s: a record of %u bytes was given as %zu", head.name, head.record_bytes, record_bytes);
	if (writer->last_name[0] && name_compare(writer->last_name, strlen(writer->last_name), head.name, strlen(head.name)) >= 0)
		return error_argument(error, "%s: comes after %s, names must ascend", head.name, writer->last_name);
	memcpy(writer->last_name, head.name, sizeof head.name);
	index_add(&writer->index, head.name, writer->file_bytes, head.record_bytes, head.head_bytes);
	return writer_append(writer, record, record_bytes, error);
}

static bp_status page_append(void *user, const uint8_t page[PAGE_BYTES], bp_error *error)
{
	return writer_append(user, page, PAGE_BYTES, error);
}

/* Index and header: the archive is whole then, where it is. */
static bp_status writer_end(struct archive_writer *writer, bp_error *error)
{
	struct archive_header header = {.count = writer->index.count, .index_offset = writer->file_bytes};
	uint8_t bytes[ARCHIVE_HEADER_BYTES];
	bp_status status = index_write(&writer->index, page_append, writer, &header.page_count, &header.depth, error);
	if (!status)
		status = pending_flush(writer, 0, error);
	if (status)
		return status;
	header.file_bytes = writer->file_bytes;
	archive_header_write(&header, bytes);
	if (writer->in_memory) {
		memcpy(writer->pending.bytes, bytes, sizeof bytes);
		return BP_OK;
	}
	if (lseek(writer->file.fd, 0, SEEK_SET) != 0)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot seek: %s", writer->file.target, strerror(errno));
	return output_file_write(&writer->file, bytes, sizeof bytes, error);
}

bp_status archive_writer_commit(struct archive_writer *writer, bp_error *error)
{
	bp_status status = writer_end(writer, error);
	if (!status)
		status = output_file_commit_synced(&writer->file, error);
	archive_writer_discard(writer);
	return status;
}

bp_status archive_writer_commit_memory(struct archive_writer *writer, uint8_t **bytes, size_t *count, bp_error *error)
{
	const bp_status status = writer_end(writer, error);
	if (!status) {
		*bytes = writer->pending.bytes;
		*count = writer->pending.count;
		writer->pending = (struct byte_buffer){0};
	}
	archive_writer_discard(writer);
	return status;
}

void archive_writer_discard(struct archive_writer *writer)
{
	if (!writer)
		return;
	output_file_discard(&writer->file);
	byte_buffer_free(&writer->pending);
	byte_buffer_free(&writer->index.entries);
	free(writer);
}
