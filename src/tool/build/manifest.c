#include "manifest.h"

#include "name.h"
#include "merl/source_kind.h"
#include "error.h"
#include "memory.h"
#include "merl/sha256.h"
#include "tool/whole_file.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_MAX = 64 };

/* What each column of a table holds. */
enum column { COLUMN_OTHER, COLUMN_NAME, COLUMN_BYTES, COLUMN_SHA256 };

struct parser {
	char *next, *end; /* of the text that is left */
	uint32_t line;
	enum column columns[COLUMNS_MAX];
	bool decided;    /* the first line has been seen */
	uint64_t offset; /* of the line, for errors */
};

static bp_status refuse(const struct parser *parser, const char *what, const char *found, bp_error *error)
{
	return error_set(error, BP_ERROR_BAD_INPUT, parser->offset, "line %" PRIu32 ": %s: '%.100s'", parser->line, what, found);
}

/* Cuts the next line that says something out of the text, without its line end. NULL at the end. */
static char *line_next(struct parser *parser, const char *start)
{
	while (parser->next < parser->end) {
		char *line = parser->next;
		char *stop = memchr(line, '\n', (size_t)(parser->end - line));
		if (!stop)
			stop = parser->end;
		parser->next = stop < parser->end ? stop + 1 : stop;
		parser->line++;
		parser->offset = (uint64_t)(line - start);
		*stop = '\0'; /* at the very end this is the spare byte */
		if (stop > line && stop[-1] == '\r')
			stop[-1] = '\0';
		if (line[0] && line[0] != '#')
			return line;
	}
	return NULL;
}

static size_t columns_split(char *line, char **cells)
{
	size_t count = 0;
	for (char *cell = line; cell && count < COLUMNS_MAX; count++) {
		cells[count] = cell;
		cell = strchr(cell, '\t');
		if (cell)
			*cell++ = '\0';
	}
	return count;
}

/* Decides what the columns are; true when this first line is a header and names no material. */
static bool columns_decide(struct parser *parser, char **cells, size_t count)
{
	static const char *const NAMES[] = {[COLUMN_NAME] = "name", [COLUMN_BYTES] = "bytes", [COLUMN_SHA256] = "sha256"};
	static const enum column USUAL[] = {COLUMN_NAME, COLUMN_BYTES, COLUMN_SHA256};
	bool has_name = false;
	for (size_t i = 0; i < count; i++)
		for (int column = COLUMN_NAME; column <= COLUMN_SHA256; column++)
			if (!strcmp(cells[i], NAMES[column])) {
				parser->columns[i] = (enum column)column;
				has_name |= column == COLUMN_NAME;
			}
	parser->decided = true;
	if (count > 1 && has_name)
		return true;
	memset(parser->columns, 0, sizeof parser->columns);
	memcpy(parser->columns, USUAL, sizeof USUAL);
	return false;
}

static bool bytes_parse(const char *text, uint64_t *out)
{
	uint64_t value = 0;
	if (!*text || strspn(text, "0123456789") != strlen(text))
		return false;
	for (; *text; text++)
		if (__builtin_mul_overflow(value, 10u, &value) || __builtin_add_overflow(value, (uint64_t)(*text - '0'), &value))
			return false;
	*out = value;
	return true;
}

/* The material that NAME.binary or FOLDER/NAME.binary stands for; anything else is a name. */
static char *name_bare(char *cell)
{
	const size_t suffix = source_suffix_bytes(cell);
	char *slash = strrchr(cell, '/');
	if (!suffix)
		return cell;
	cell[strlen(cell) - suffix] = '\0';
	return slash ? slash + 1 : cell;
}

static bp_status entry_parse(const struct parser *parser, char **cells, size_t count, struct manifest_entry *entry,
                             bp_error *error)
{
	*entry = (struct manifest_entry){.line = parser->line};
	for (size_t i = 0; i < count; i++) {
		char *cell = cells[i];
		switch (parser->columns[i]) {
		case COLUMN_NAME: entry->name = name_bare(cell); break;
		case COLUMN_BYTES:
			if (*cell && !bytes_parse(cell, &entry->bytes))
				return refuse(parser, "bytes: expected a whole number, found", cell, error);
			entry->has_bytes = *cell;
			break;
		case COLUMN_SHA256:
			if (*cell && !sha256_from_hex(cell, entry->sha256))
				return refuse(parser, "sha256: expected 64 hexadecimal digits, found", cell, error);
			entry->has_sha256 = *cell;
			break;
		case COLUMN_OTHER: break;
		}
	}
	if (!entry->name)
		return refuse(parser, "no name in this line", cells[0], error);
	const char *fault = name_fault(entry->name, strlen(entry->name));
	if (fault)
		return error_set(error, BP_ERROR_BAD_INPUT, parser->offset, "line %" PRIu32 ": illegal name '%.100s': %s", parser->line,
		                 entry->name, fault);
	return BP_OK;
}

static int entry_compare(const void *a, const void *b)
{
	const struct manifest_entry *x = a, *y = b;
	int order = strcmp(x->name, y->name);
	return order ? order : (x->line > y->line) - (x->line < y->line);
}

static bp_status duplicates_refuse(const struct manifest *manifest, bp_error *error)
{
	for (size_t i = 1; i < manifest->count; i++) {
		const struct manifest_entry *a = &manifest->entries[i - 1], *b = &manifest->entries[i];
		if (!strcmp(a->name, b->name))
			return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
			                 "line %" PRIu32 ": '%.100s' stands in line %" PRIu32 " already", b->line, b->name, a->line);
	}
	return BP_OK;
}

bp_status manifest_parse(char *text, size_t bytes, struct manifest *out, bp_error *error)
{
	struct manifest manifest = {.text = text};
	struct parser parser = {.next = text, .end = text + bytes};
	char *line, *cells[COLUMNS_MAX];
	bp_status status = BP_OK;

	if (bytes >= 2 && (!memcmp(text, "\xFF\xFE", 2) || !memcmp(text, "\xFE\xFF", 2))) {
		status = error_set(error, BP_ERROR_BAD_INPUT, 0, "this is UTF-16; save it as UTF-8");
		goto out;
	}
	if (bytes >= 3 && !memcmp(text, "\xEF\xBB\xBF", 3))
		parser.next += 3; /* a byte order mark */
	const char *nul = memchr(text, '\0', bytes);
	if (nul) {
		status = error_set(error, BP_ERROR_BAD_INPUT, (uint64_t)(nul - text), "a NUL byte: this is not a text file");
		goto out;
	}
	while ((line = line_next(&parser, text))) {
		size_t count = columns_split(line, cells);
		if (!parser.decided && columns_decide(&parser, cells, count))
			continue;
		struct manifest_entry *entries = memory_grown(manifest.entries, manifest.count, sizeof *entries);
		if (!entries) {
			status = error_memory(error, manifest.count * sizeof *entries);
			goto out;
		}
		manifest.entries = entries;
		status = entry_parse(&parser, cells, count, &manifest.entries[manifest.count], error);
		if (status)
			goto out;
		manifest.count++;
	}
	if (manifest.count == 0) {
		status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "no material is listed");
		goto out;
	}
	qsort(manifest.entries, manifest.count, sizeof *manifest.entries, entry_compare);
	status = duplicates_refuse(&manifest, error);
out:
	if (status)
		manifest_free(&manifest);
	else
		*out = manifest;
	return status;
}

bp_status manifest_read(const char *path, struct manifest *out, bp_error *error)
{
	char *text;
	size_t bytes;
	const bp_status status = whole_file_read(path, MANIFEST_FILE_BYTES_MAX, &text, &bytes, error);
	return status ? status : manifest_parse(text, bytes, out, error);
}

void manifest_free(struct manifest *manifest)
{
	normal_forms_free(&manifest->forms);
	free(manifest->entries);
	free(manifest->text);
	*manifest = (struct manifest){0};
}

void manifest_note_unlisted(struct manifest *manifest, const char *name)
{
	size_t number;
	for (size_t n = 0; n < manifest->count && !manifest->forms_made; n++)
		normal_forms_add(&manifest->forms, manifest->entries[n].name, n);
	manifest->forms_made = true;
	if (normal_forms_find(&manifest->forms, name, &number))
		manifest->entries[number].other_form = true;
}

static int name_compare_to(const void *name, const void *entry)
{
	return strcmp(name, ((const struct manifest_entry *)entry)->name);
}

struct manifest_entry *manifest_find(const struct manifest *manifest, const char *name)
{
	return manifest->count ? bsearch(name, manifest->entries, manifest->count, sizeof *manifest->entries, name_compare_to) : NULL;
}

bp_status manifest_check(const struct manifest_entry *entry, uint64_t bytes, const uint8_t sha256[32], bp_error *error)
{
	if (entry->has_bytes && entry->bytes != bytes)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
		                 "the manifest expects %" PRIu64 " bytes, the file has %" PRIu64 "; is it another file of this name?",
		                 entry->bytes, bytes);
	if (entry->has_sha256 && memcmp(entry->sha256, sha256, 32) != 0) {
		char expected[SHA256_HEX_CHARACTERS + 1], found[SHA256_HEX_CHARACTERS + 1];
		sha256_to_hex(entry->sha256, expected);
		sha256_to_hex(sha256, found);
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
		                 "the manifest expects SHA-256 %s, the file has %s; is it another file of this name?", expected, found);
	}
	return BP_OK;
}
