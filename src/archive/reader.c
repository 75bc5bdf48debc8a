#include "reader.h"

#include <stdlib.h>
#include <string.h>

#include "codec/record_origin.h"
#include "error.h"
#include "name.h"
#include "system.h"

struct bp_archive {
	struct system_file *file; /* NULL: read through source */
	bp_source source;
	struct archive_header header;
	_Atomic uint64_t *bytes_read; /* apart, so that a const handle can count */
	struct index_page root;       /* count 0 when the archive is empty */
	char path[];                  /* "" where there is none */
};

bp_status archive_read(const struct bp_archive *archive, uint64_t offset, void *bytes, size_t count, bp_error *error)
{
	size_t got = 0;
	uint64_t end = archive->source.bytes;
	if (archive->file) {
		bp_error reason;
		if (system_file_read(archive->file, offset, bytes, count, &got, &reason))
			return error_set(error, BP_ERROR_IO, reason.offset, "%s: cannot read: %s", archive->path, reason.message);
		if (got < count)
			end = system_file_bytes(archive->file, offset + got);
	} else if (offset <= end && count <= end - offset) {
		if (count && archive->source.read(archive->source.user, offset, bytes, count) != 0)
			return error_set(error, BP_ERROR_IO, offset, "the caller's function cannot read %zu bytes here", count);
		got = count;
	}
	*archive->bytes_read += got;
	if (got == count)
		return BP_OK;
	return error_set(error, BP_ERROR_CORRUPT, end < offset + got ? end : offset + got,
	                 "the file ends here, bytes up to %llu were expected", (unsigned long long)(offset + count));
}

const struct archive_header *archive_header(const struct bp_archive *archive) { return &archive->header; }

const char *archive_path(const struct bp_archive *archive) { return archive->path; }

bp_status archive_page_read(const struct bp_archive *archive, const struct page_expect *expect, struct index_page *page,
                            bp_error *error)
{
	uint64_t offset = archive->header.index_offset + (uint64_t)expect->number * PAGE_BYTES;
	page->count = 0;
	if (expect->number >= archive->header.page_count)
		return error_set(error, BP_ERROR_CORRUPT, BP_NO_OFFSET, "the index points to page %u of %u", expect->number,
		                 archive->header.page_count);
	bp_status status = archive_read(archive, offset, page->bytes, PAGE_BYTES, error);
	if (!status)
		status = error_shift(index_page_read(page, expect, error), offset, error);
	if (status)
		page->count = 0;
	return status;
}

static bp_status header_and_root_read(struct bp_archive *archive, uint64_t file_bytes, bp_error *error)
{
	uint8_t bytes[ARCHIVE_HEADER_BYTES];
	size_t count = file_bytes < sizeof bytes ? (size_t)file_bytes : sizeof bytes;
	struct page_expect root;
	bp_status status = archive_read(archive, 0, bytes, count, error);
	if (!status)
		status = archive_header_read(bytes, count, file_bytes, &archive->header, error);
	if (status || archive->header.count == 0)
		return status;
	root = (struct page_expect){.number = archive->header.page_count - 1, .level = archive->header.depth - 1};
	return archive_page_read(archive, &root, &archive->root, error);
}

/* Opens what *archive already reads from; closes it where that fails. */
static bp_status archive_begin(struct bp_archive *archive, uint64_t file_bytes, bp_archive **out, bp_error *error)
{
	const bp_status status = header_and_root_read(archive, file_bytes, error);
	if (status) {
		archive->source.close = NULL; /* it stays the caller's */
		bp_archive_close(archive);
		return status;
	}
	*out = archive;
	return BP_OK;
}

static bp_status archive_new(const char *path, struct bp_archive **out, bp_error *error)
{
	const size_t path_bytes = strlen(path) + 1;
	struct bp_archive *archive = calloc(1, sizeof *archive + path_bytes);
	if (archive)
		archive->bytes_read = calloc(1, sizeof *archive->bytes_read);
	if (!archive || !archive->bytes_read) {
		bp_archive_close(archive);
		return error_memory(error, sizeof *archive + path_bytes);
	}
	memcpy(archive->path, path, path_bytes);
	*out = archive;
	return BP_OK;
}

bp_status bp_archive_open(const char *path, bp_archive **out, bp_error *error)
{
	struct bp_archive *archive = NULL;
	uint64_t file_bytes = 0;

	if (!path || !out)
		return error_argument(error, "a path and a place for the handle are needed");
	bp_status status = archive_new(path, &archive, error);
	if (status)
		return status;
	status = system_file_open(path, &archive->file, &file_bytes, error);
	if (status) {
		bp_archive_close(archive);
		return status;
	}
	return archive_begin(archive, file_bytes, out, error);
}

bp_status bp_archive_open_source(const bp_source *source, bp_archive **out, bp_error *error)
{
	struct bp_archive *archive = NULL;

	if (!source || !out || source->struct_bytes != sizeof *source || !source->read)
		return error_argument(error, "a bp_source with struct_bytes and read, and a place for the handle are needed");
	bp_status status = archive_new("", &archive, error);
	if (status)
		return status;
	archive->source = *source;
	return archive_begin(archive, source->bytes, out, error);
}

static int memory_read(void *user, uint64_t offset, void *bytes, size_t count)
{
	memcpy(bytes, (const uint8_t *)user + offset, count);
	return 0;
}

bp_status bp_archive_open_memory(const void *bytes, size_t count, bp_archive **out, bp_error *error)
{
	/* user is not written through, whatever its type */
	const bp_source source = {
		.struct_bytes = sizeof source, .read = memory_read, .user = (void *)(uintptr_t)bytes, .bytes = count};
	if (!bytes)
		return error_argument(error, "the archive's bytes are needed");
	return bp_archive_open_source(&source, out, error);
}

void bp_archive_close(bp_archive *archive)
{
	if (!archive)
		return;
	if (archive->source.close)
		archive->source.close(archive->source.user);
	system_file_close(archive->file);
	free((void *)archive->bytes_read);
	free(archive);
}

uint64_t bp_archive_count(const bp_archive *archive) { return archive->header.count; }

uint64_t bp_archive_bytes_read(const bp_archive *archive) { return *archive->bytes_read; }

/* Follows one path of pages from the root to the leaf that holds the name (or, name NULL, the ordinal). */
static bp_status leaf_find(const struct bp_archive *archive, const char *name, uint64_t ordinal, struct index_page *leaf,
                           bp_error *error)
{
	struct index_page inner;
	const struct index_page *page = &archive->root;
	while (page->level) {
		uint32_t i = index_search(page, name, ordinal);
		struct page_expect child;
		char first_name[BP_NAME_BYTES_MAX + 1];
		if (i == UINT32_MAX)
			i = 0; /* the name comes before all others: the first leaf will not have it */
		child = index_child(page, i);
		/* The page is about to be overwritten by its child. */
		memcpy(first_name, child.first_name, child.first_name_bytes);
		child.first_name = first_name;
		bp_status status = archive_page_read(archive, &child, child.level ? &inner : leaf, error);
		if (status)
			return status;
		page = child.level ? &inner : leaf;
	}
	if (page == &archive->root)
		*leaf = *page;
	return BP_OK;
}

bp_status archive_entry(const struct bp_archive *archive, uint64_t index, struct index_page *leaf, struct index_entry *entry,
                        bp_error *error)
{
	struct index_page own;
	if (!leaf) {
		own.count = 0;
		leaf = &own;
	}
	if (index >= archive->header.count)
		return error_set(error, BP_ERROR_NOT_FOUND, BP_NO_OFFSET, "there is no material %llu; the archive has %llu",
		                 (unsigned long long)index, (unsigned long long)archive->header.count);
	if (leaf->count == 0 || index < leaf->first_ordinal || index - leaf->first_ordinal >= leaf->count) {
		bp_status status = leaf_find(archive, NULL, index, leaf, error);
		if (status)
			return status;
		if (index < leaf->first_ordinal || index - leaf->first_ordinal >= leaf->count)
			return error_set(error, BP_ERROR_CORRUPT, archive->header.index_offset + (uint64_t)leaf->number * PAGE_BYTES,
			                 "index page %u should hold material %llu", leaf->number, (unsigned long long)index);
	}
	index_leaf_entry(leaf, (uint32_t)(index - leaf->first_ordinal), entry);
	return BP_OK;
}

bp_status bp_archive_name(const bp_archive *archive, uint64_t index, char name[BP_NAME_BYTES_MAX + 1], bp_error *error)
{
	struct index_entry entry;
	const bp_status status = archive_entry(archive, index, NULL, &entry, error);
	if (!status)
		memcpy(name, entry.name, entry.name_bytes + 1);
	return status;
}

bp_status bp_archive_find(const bp_archive *archive, const char *name, uint64_t *index, bp_error *error)
{
	struct index_page leaf;
	uint32_t i, bytes;
	if (!name || !index)
		return error_argument(error, "a name and a place for its number are needed");
	bp_status status = leaf_find(archive, name, 0, &leaf, error);
	if (status)
		return status;
	i = index_search(&leaf, name, 0);
	const char *here = i == UINT32_MAX ? "" : index_entry_name(&leaf, i, &bytes);
	if (i == UINT32_MAX || name_compare(here, bytes, name, strlen(name)) != 0)
		return error_set(error, BP_ERROR_NOT_FOUND, BP_NO_OFFSET, "there is no material \"%s\"", name);
	if (leaf.first_ordinal >= archive->header.count || i >= archive->header.count - leaf.first_ordinal)
		return error_set(error, BP_ERROR_CORRUPT, archive->header.index_offset + (uint64_t)leaf.number * PAGE_BYTES,
		                 "the index numbers \"%s\" %llu of %llu", name, (unsigned long long)(leaf.first_ordinal + i),
		                 (unsigned long long)archive->header.count);
	*index = leaf.first_ordinal + i;
	return BP_OK;
}

/* The record lies between header and index. */
static bp_status entry_check(const struct bp_archive *archive, const struct index_entry *entry, bp_error *error)
{
	uint64_t end = archive->header.index_offset;
	if (entry->offset < ARCHIVE_HEADER_BYTES || entry->offset > end || end - entry->offset < entry->record_bytes)
		return error_set(error, BP_ERROR_CORRUPT, entry->offset, "%s: the index places %u bytes at %llu, records end at %llu",
		                 entry->name, entry->record_bytes, (unsigned long long)entry->offset, (unsigned long long)end);
	return BP_OK;
}

/* The head that was read is the one that the index promised. */
static bp_status head_check(const struct index_entry *entry, const struct record_head *head, bp_error *error)
{
	if (strcmp(entry->name, head->name) != 0 || entry->head_bytes != head->head_bytes ||
	    entry->record_bytes != head->record_bytes)
		return error_set(error, BP_ERROR_CORRUPT, entry->offset,
		                 "the index promises \"%s\" of %u bytes here, there is \"%s\" of %u", entry->name, entry->record_bytes,
		                 head->name, head->record_bytes);
	return BP_OK;
}

bp_status archive_entry_head(const struct bp_archive *archive, const struct index_entry *entry, struct record_head *out,
                             bp_error *error)
{
	uint8_t bytes[RECORD_HEAD_BYTES_MAX];
	bp_status status = entry_check(archive, entry, error);
	if (!status)
		status = archive_read(archive, entry->offset, bytes, entry->head_bytes, error);
	if (!status)
		status = error_shift(record_head_read(bytes, entry->head_bytes, out, error), entry->offset, error);
	return status ? status : head_check(entry, out, error);
}

bp_status archive_entry_record(const struct bp_archive *archive, const struct index_entry *entry, struct record_head *out,
                               uint8_t **out_record, bp_error *error)
{
	bp_status status = entry_check(archive, entry, error);
	if (status)
		return status;
	uint8_t *record = malloc(entry->record_bytes);
	if (!record)
		return error_memory(error, entry->record_bytes);
	status = archive_read(archive, entry->offset, record, entry->record_bytes, error);
	if (!status)
		status = error_shift(record_verify(record, entry->record_bytes, out, error), entry->offset, error);
	if (!status)
		status = head_check(entry, out, error);
	if (status)
		free(record);
	else
		*out_record = record;
	return status;
}

bp_status archive_record_head(const struct bp_archive *archive, uint64_t index, struct index_entry *entry,
                              struct record_head *head, bp_error *error)
{
	const bp_status status = archive_entry(archive, index, NULL, entry, error);
	return status ? status : archive_entry_head(archive, entry, head, error);
}

struct fetch_place {
	const struct bp_archive *archive;
	uint64_t offset; /* of the record */
};

static bp_status record_fetch(void *user, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error)
{
	const struct fetch_place *place = user;
	/* record_decode speaks of offsets from the record's start, and so do we to it. */
	return error_shift(archive_read(place->archive, place->offset + offset, bytes, count, error), -place->offset, error);
}

bp_status archive_entry_load(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                             uint32_t layers, struct model **out, bp_error *error)
{
	struct fetch_place place = {.archive = archive, .offset = entry->offset};
	return error_shift(record_decode(head, layers, record_fetch, &place, out, error), entry->offset, error);
}

bp_status archive_entry_expand(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                               uint32_t layers, struct expansion *table, bp_error *error)
{
	struct model *model = NULL;
	bp_status status = archive_entry_load(archive, entry, head, layers, &model, error);
	if (!status)
		status = model_expand(model, 0, table, error);
	model_free(model);
	return status;
}

bp_status archive_model_load(const struct bp_archive *archive, uint64_t index, uint32_t layers, struct model **out,
                             bp_error *error)
{
	struct index_entry entry;
	struct record_head head;
	const bp_status status = archive_record_head(archive, index, &entry, &head, error);
	return status ? status : archive_entry_load(archive, &entry, &head, layers, out, error);
}

bp_status archive_entry_origin(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                               struct origin *out, bp_error *error)
{
	const struct record_section *section = record_origin_find(head);
	uint8_t bytes[ORIGIN_BYTES];
	*out = (struct origin){.kind = ORIGIN_MERL};
	if (!section)
		return BP_OK;
	const uint64_t at = entry->offset + section->offset;
	bp_status status = archive_read(archive, at, bytes, sizeof bytes, error);
	if (!status && bytes_crc32(bytes, sizeof bytes) != section->crc32)
		status = error_set(error, BP_ERROR_CHECKSUM, at, "the checksum of a section of type %u differs", section->type);
	return status ? status : error_shift(record_origin_parse(bytes, out, error), at, error);
}
