/*
 * verify.c: reads all of an archive and checks what FORMAT.md says of it: the header, the tree of index
 * pages, that records follow each other without gap in name order, and every checksum.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "environment.h"
#include "error.h"
#include "reader.h"

struct walk {
	const bp_archive *archive;
	unsigned flags;
	bp_problem_fn *report;
	void *user;
	bp_error *first; /* of the caller; may be NULL */
	bp_status status;
	bool ended;            /* the caller has seen enough */
	uint64_t next_ordinal; /* that the next leaf should begin with */
	uint64_t next_offset;  /* where the next record should begin; 0 after damage: unknown */
	uint64_t pages_seen;
	char last_name[BP_NAME_BYTES_MAX + 1]; /* "" before the first leaf */
};

static void problem_report(struct walk *walk, const char *material, const bp_error *error)
{
	bp_problem problem = {.material = material, .error = *error};
	if (walk->ended)
		return;
	if (!walk->status) {
		walk->status = error->status;
		if (walk->first)
			*walk->first = *error;
	}
	walk->ended = walk->report && walk->report(walk->user, &problem) != 0;
}

/* What is wrong at `offset` of the file; material NULL: the header or the index. */
static void problem_tell(struct walk *walk, const char *material, uint64_t offset, const char *format, ...)
	__attribute__((format(printf, 4, 5)));

static void problem_tell(struct walk *walk, const char *material, uint64_t offset, const char *format, ...)
{
	bp_error error;
	char text[2 * sizeof error.message];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(text, sizeof text, format, arguments);
	va_end(arguments);
	error_set(&error, BP_ERROR_CORRUPT, offset, "%s", text);
	problem_report(walk, material, &error);
}

/* Every value of the expanded layer is finite and not negative. */
static bp_status layer_check(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                             uint32_t layers, struct expansion *table, bp_error *error)
{
	const size_t cells = lattice_cells(head->dims);
	const bp_status status = archive_entry_expand(archive, entry, head, layers, table, error);
	if (status)
		return status;
	if (!(table->unit > 0 && isfinite(table->unit)))
		return error_set(error, BP_ERROR_CORRUPT, entry->offset, "layer %u: the unit of its values is %g", layers - 1,
		                 table->unit);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < cells; i++)
			if (!(table->rgb[c][i] >= 0 && isfinite(table->rgb[c][i])))
				return error_set(error, BP_ERROR_CORRUPT, entry->offset, "layer %u: channel %d of cell %zu decodes to %g",
				                 layers - 1, c, i, (double)table->rgb[c][i]);
	return BP_OK;
}

static bp_status layers_check(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                              bp_error *error)
{
	struct expansion table = {0};
	bp_status status = BP_OK;
	fenv_t before;
	environment_enter(&before);
	for (uint32_t l = 1; !status && l <= head->layer_count; l++)
		status = layer_check(archive, entry, head, l, &table, error);
	environment_leave(&before);
	expansion_free(&table);
	return status;
}

static void record_check(struct walk *walk, const struct index_entry *entry)
{
	struct record_head head;
	uint8_t *record = NULL;
	bp_error error = {0};
	if (walk->next_offset && entry->offset != walk->next_offset)
		problem_tell(walk, entry->name, walk->next_offset, "a record should begin here, the index has it at %llu",
		             (unsigned long long)entry->offset);
	/* After an entry that points nowhere the next one may be right again. */
	walk->next_offset = entry->offset <= archive_header(walk->archive)->index_offset ? entry->offset + entry->record_bytes : 0;
	if (archive_entry_record(walk->archive, entry, &head, &record, &error) != BP_OK) {
		problem_report(walk, entry->name, &error);
		return;
	}
	free(record);
	if (!(walk->flags & BP_VERIFY_DEEP))
		return;
	struct origin origin;
	if (archive_entry_origin(walk->archive, entry, &head, &origin, &error) != BP_OK)
		problem_report(walk, entry->name, &error);
	if (layers_check(walk->archive, entry, &head, &error) != BP_OK)
		problem_report(walk, entry->name, &error);
}

/* The first name of this leaf comes after the last of the one before, and so does its number. */
static void leaf_check(struct walk *walk, const struct index_page *leaf)
{
	uint64_t page_offset = archive_header(walk->archive)->index_offset + (uint64_t)leaf->number * PAGE_BYTES;
	struct index_entry entry;
	index_leaf_entry(leaf, 0, &entry);
	if (walk->last_name[0] && strcmp(walk->last_name, entry.name) >= 0) /* as name_compare: names hold no NUL */
		problem_tell(walk, NULL, page_offset, "index page %u is not in name order", leaf->number);
	if (leaf->first_ordinal != walk->next_ordinal)
		problem_tell(walk, NULL, page_offset, "index page %u begins with material %llu, expected %llu", leaf->number,
		             (unsigned long long)leaf->first_ordinal, (unsigned long long)walk->next_ordinal);
	for (uint32_t i = 0; i < leaf->count && !walk->ended; i++) {
		index_leaf_entry(leaf, i, &entry);
		record_check(walk, &entry);
	}
	walk->next_ordinal = leaf->first_ordinal + leaf->count;
	strcpy(walk->last_name, entry.name);
}

static void page_walk(struct walk *walk, const struct page_expect *expect, uint64_t end_ordinal)
{
	struct index_page page;
	bp_error error;
	/* A hostile tree could lead to the same page on many ways. */
	if (walk->ended || ++walk->pages_seen > archive_header(walk->archive)->page_count)
		return;
	if (archive_page_read(walk->archive, expect, &page, &error) != BP_OK) {
		problem_report(walk, NULL, &error);
		walk->next_ordinal = end_ordinal;
		walk->next_offset = 0;
		return;
	}
	if (page.level == 0) {
		leaf_check(walk, &page);
		return;
	}
	for (uint32_t i = 0; i < page.count && !walk->ended; i++) {
		struct page_expect child = index_child(&page, i);
		page_walk(walk, &child, index_child_end(&page, i, end_ordinal));
	}
}

/* What the whole walk must have come to. */
static void totals_check(struct walk *walk, const struct archive_header *header)
{
	if (walk->next_ordinal != header->count)
		problem_tell(walk, NULL, header->index_offset, "the index holds %llu materials, the header says %llu",
		             (unsigned long long)walk->next_ordinal, (unsigned long long)header->count);
	if (walk->pages_seen != header->page_count && !walk->status)
		problem_tell(walk, NULL, header->index_offset, "the index uses %llu of its %u pages",
		             (unsigned long long)walk->pages_seen, header->page_count);
	if (walk->next_offset && walk->next_offset != header->index_offset)
		problem_tell(walk, NULL, walk->next_offset, "the records end here, the index begins at %llu",
		             (unsigned long long)header->index_offset);
}

bp_status bp_archive_verify(const bp_archive *archive, unsigned flags, bp_problem_fn *report, void *user, bp_error *error)
{
	struct archive_header again;
	struct walk walk = {.archive = archive, .flags = flags, .report = report, .user = user, .first = error};
	uint8_t bytes[ARCHIVE_HEADER_BYTES];
	bp_error problem;

	if (!archive || flags & ~BP_VERIFY_DEEP)
		return error_argument(error, "no archive, or unknown flags");
	const struct archive_header *header = archive_header(archive);
	walk.next_offset = ARCHIVE_HEADER_BYTES;
	if (archive_read(archive, 0, bytes, sizeof bytes, &problem) != BP_OK ||
	    archive_header_read(bytes, sizeof bytes, header->file_bytes, &again, &problem) != BP_OK)
		problem_report(&walk, NULL, &problem);
	if (header->page_count && !walk.ended) {
		struct page_expect root = {.number = header->page_count - 1, .level = header->depth - 1};
		page_walk(&walk, &root, header->count);
	}
	if (!walk.ended)
		totals_check(&walk, header);
	return walk.status;
}
