#include "recover.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "codec/record.h"
#include "error.h"
#include "memory.h"
#include "index.h"
#include "system.h"
#include "writer.h"

/* A material that was seen: a record (offset > 0), or only its name in the index. */
struct seen {
	uint64_t offset;
	uint32_t bytes;
	bool intact;
	uint32_t name; /* where it begins in the scan's names */
};

struct scan {
	struct system_file *file;
	const char *path;
	uint64_t file_bytes;
	recover_report_fn *report;
	void *user;
	struct seen *seen;
	size_t count;
	size_t record_count;              /* records come before what only the index names, unless an archive stands behind another */
	struct byte_buffer names;         /* each with its NUL: a million take some 10 MB, in fixed places they would take 256 */
	uint8_t record[RECORD_BYTES_MAX]; /* the candidate; the scan is malloc'ed */
};

/* Reads what is there of `count` bytes at `offset`; a bad block of the disk reads as zeros up to the next 4096. */
static size_t scan_read(const struct scan *scan, uint64_t offset, uint8_t *bytes, size_t count)
{
	size_t done = 0, got;
	if (offset >= scan->file_bytes)
		return 0;
	if (count > scan->file_bytes - offset)
		count = (size_t)(scan->file_bytes - offset);
	while (system_file_read(scan->file, offset + done, bytes + done, count - done, &got, NULL) != BP_OK) {
		done += got;
		const size_t hole = 4096 - (size_t)((offset + done) % 4096), zeros = hole < count - done ? hole : count - done;
		memset(bytes + done, 0, zeros);
		done += zeros;
	}
	return done + got;
}

static bp_status seen_add(struct scan *scan, const char *name, uint64_t offset, uint32_t bytes, bool intact, bp_error *error)
{
	struct seen *grown = memory_grown(scan->seen, scan->count, sizeof *grown);
	if (!grown)
		return error_memory(error, scan->count * sizeof *grown);
	scan->seen = grown;
	if (scan->names.count > UINT32_MAX - BP_NAME_BYTES_MAX - 1)
		return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "%s: too many names to remember", scan->path);
	struct seen *entry = &scan->seen[scan->count++];
	*entry = (struct seen){.offset = offset, .bytes = bytes, .intact = intact, .name = (uint32_t)scan->names.count};
	write_bytes(&scan->names, name, strlen(name) + 1);
	return scan->names.failed ? error_memory(error, scan->names.count) : BP_OK;
}

/* A record at `offset`? *next is where to look on. */
static bp_status record_try(struct scan *scan, uint64_t offset, uint64_t *next, bp_error *error)
{
	struct record_head head, whole;
	uint32_t head_bytes, record_bytes;
	const size_t there = scan_read(scan, offset, scan->record, RECORD_HEAD_BYTES_MAX);
	*next = offset + 1;
	if (there < RECORD_PROBE_BYTES || record_probe(scan->record, &head_bytes, &record_bytes, NULL) != BP_OK ||
	    record_head_read(scan->record, there, &head, NULL) != BP_OK)
		return BP_OK;
	bool intact = record_verify(scan->record, scan_read(scan, offset, scan->record, record_bytes), &whole, NULL) == BP_OK;
	*next = offset + (intact ? record_bytes : head_bytes);
	if (scan->record_count == scan->count)
		scan->record_count++;
	return seen_add(scan, head.name, offset, record_bytes, intact, error);
}

static const char *seen_name(const struct scan *scan, const struct seen *seen)
{
	return (const char *)scan->names.bytes + seen->name;
}

/* Is the record that the index has at `offset` one that was found, intact, of that name? Those found are in the file's order. */
static bool record_found(const struct scan *scan, const struct index_entry *entry)
{
	size_t low = 0, high = scan->record_count;
	while (low < high) {
		const size_t middle = (low + high) / 2;
		if (scan->seen[middle].offset < entry->offset)
			low = middle + 1;
		else
			high = middle;
	}
	return low < scan->record_count && scan->seen[low].offset == entry->offset && scan->seen[low].intact &&
	       !strcmp(seen_name(scan, &scan->seen[low]), entry->name);
}

/* A leaf of the index at `offset`? Its names are worth having, whatever became of the tree above it. */
static bp_status leaf_try(struct scan *scan, uint64_t offset, uint64_t *next, bp_error *error)
{
	struct index_page page;
	struct page_expect expect = {0};
	*next = offset + 1;
	if (scan_read(scan, offset, page.bytes, PAGE_BYTES) != PAGE_BYTES || load_u16(page.bytes + 4) != 0)
		return BP_OK;
	expect.first_ordinal = load_u64(page.bytes + 8);
	if (index_page_read(&page, &expect, NULL) != BP_OK)
		return BP_OK;
	*next = offset + PAGE_BYTES;
	for (uint32_t i = 0; i < page.count; i++) {
		struct index_entry entry;
		index_leaf_entry(&page, i, &entry);
		if (record_found(scan, &entry))
			continue;
		bp_status status = seen_add(scan, entry.name, entry.offset, 0, false, error);
		if (status)
			return status;
	}
	return BP_OK;
}

/* Both magics begin with 0x8B. */
static bp_status file_scan(struct scan *scan, bp_error *error)
{
	enum { WINDOW = 1 << 20 };
	uint8_t *window = malloc(WINDOW);
	uint64_t base = 0, position = 0; /* the window's place; where to look next */
	size_t there = 0;
	bp_status status = BP_OK;
	if (!window)
		return error_memory(error, WINDOW);
	while (!status && position + RECORD_PROBE_BYTES <= scan->file_bytes) {
		if (position < base || position + RECORD_PROBE_BYTES > base + there) {
			base = position;
			there = scan_read(scan, base, window, WINDOW);
			if (there < RECORD_PROBE_BYTES)
				break; /* cut while it was read */
		}
		const uint8_t *found = memchr(window + (position - base), 0x8B, there - (size_t)(position - base));
		position = found ? base + (uint64_t)(found - window) : base + there;
		if (position + RECORD_PROBE_BYTES > base + there)
			continue;
		if (memcmp(found, RECORD_MAGIC, RECORD_MAGIC_BYTES) == 0)
			status = record_try(scan, position, &position, error);
		else if (memcmp(found, PAGE_MAGIC, 4) == 0)
			status = leaf_try(scan, position, &position, error);
		else
			position++;
	}
	free(window);
	return status;
}

/* By name; intact ones first, then in the file's order. */
static int seen_compare(const void *a, const void *b, void *user)
{
	const struct seen *x = a, *y = b;
	int order = strcmp(seen_name(user, x), seen_name(user, y)); /* as name_compare: names hold no NUL */
	if (order == 0)
		order = (int)y->intact - (int)x->intact;
	return order ? order : (x->offset > y->offset) - (x->offset < y->offset);
}

/* One archive's records are in order already; sorting takes memory. */
static void seen_sort(struct scan *scan)
{
	for (size_t i = 1; i < scan->count; i++)
		if (seen_compare(&scan->seen[i - 1], &scan->seen[i], scan) > 0) {
			qsort_r(scan->seen, scan->count, sizeof *scan->seen, seen_compare, scan);
			return;
		}
}

static void scan_tell(const struct scan *scan, const char *name, uint64_t offset, const char *what)
{
	bp_error why;
	error_set(&why, BP_ERROR_CORRUPT, offset, "%s", what);
	if (scan->report)
		scan->report(scan->user, name, &why);
}

/* Copies each name's first intact record. */
static bp_status records_save(struct scan *scan, struct archive_writer *writer, struct recovery *out, bp_error *error)
{
	for (size_t i = 0, same; i < scan->count; i += same) {
		const struct seen *first = &scan->seen[i];
		const char *const name = seen_name(scan, first);
		for (same = 1; i + same < scan->count && strcmp(seen_name(scan, &scan->seen[i + same]), name) == 0; same++)
			if (scan->seen[i + same].intact)
				scan_tell(scan, name, scan->seen[i + same].offset, "a second intact record of this name was not saved");
		if (!first->intact) {
			scan_tell(scan, name, first->offset, "lost: its record is damaged");
			out->lost++;
			continue;
		}
		if (scan_read(scan, first->offset, scan->record, first->bytes) != first->bytes)
			return error_set(error, BP_ERROR_IO, first->offset, "%s: changed while it was read", scan->path);
		bp_status status = archive_writer_add(writer, scan->record, first->bytes, error);
		if (status)
			return status;
		out->saved++;
	}
	return BP_OK;
}

/* How many materials the archive's header tells of; 0 where there is none that can be believed. Cut files have one. */
static uint64_t header_count(const struct scan *scan)
{
	uint8_t bytes[ARCHIVE_HEADER_BYTES] = {0};
	struct archive_header header = {0};
	if (scan_read(scan, 0, bytes, sizeof bytes) == sizeof bytes)
		archive_header_read(bytes, sizeof bytes, load_u64(bytes + ARCHIVE_AT_FILE_BYTES), &header, NULL);
	return header.count;
}

/* Where neither a record nor the index is left, the header still tells how many there were. */
static void nameless_tell(const struct scan *scan, struct recovery *out)
{
	const uint64_t count = header_count(scan), named = out->saved + out->lost;
	bp_error why;
	if (count <= named)
		return;
	error_set(&why, BP_ERROR_NOT_FOUND, BP_NO_OFFSET,
	          "%llu more of %llu materials lost: nothing is left of them, not even a name", (unsigned long long)(count - named),
	          (unsigned long long)count);
	if (scan->report)
		scan->report(scan->user, NULL, &why);
	out->lost += count - named;
}

static bp_status scan_open(struct scan *scan, const char *damaged, bp_error *error)
{
	bp_error why;
	const bp_status status = system_file_open(damaged, &scan->file, &scan->file_bytes, &why);
	scan->path = damaged;
	return status ? error_set(error, status, BP_NO_OFFSET, status == BP_ERROR_NOT_OURS ? "%s: not an archive: %s" : "%s: %s",
	                          damaged, why.message)
	              : BP_OK;
}

bp_status archive_recover(const char *damaged, const char *path, recover_report_fn *report, void *user, struct recovery *out,
                          bp_error *error)
{
	struct scan *scan = calloc(1, sizeof *scan);
	struct archive_writer *writer = NULL;
	struct recovery recovery = {0};
	bool any = false;
	if (!scan)
		return error_memory(error, sizeof *scan);
	scan->report = report;
	scan->user = user;
	bp_status status = scan_open(scan, damaged, error);
	if (!status)
		status = file_scan(scan, error);
	if (status)
		goto out;
	seen_sort(scan);
	for (size_t i = 0; i < scan->count; i++)
		any |= scan->seen[i].intact;
	if (!any) {
		status = error_set(error, BP_ERROR_NOT_FOUND, BP_NO_OFFSET, "%s: holds no intact record", damaged);
		goto out;
	}
	status = archive_writer_open(path, &writer, error);
	if (!status)
		status = records_save(scan, writer, &recovery, error);
	if (!status) {
		nameless_tell(scan, &recovery);
		status = archive_writer_commit(writer, error);
		writer = NULL;
	}
	if (!status)
		*out = recovery;
out:
	archive_writer_discard(writer);
	system_file_close(scan->file);
	free(scan->seen);
	byte_buffer_free(&scan->names);
	free(scan);
	return status;
}
