#include "selection.h"

#include "../error.h"
#include "report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t name_distance(const char *a, const char *b, size_t most)
{
	size_t a_bytes = strlen(a), b_bytes = strlen(b);
	size_t gap = a_bytes > b_bytes ? a_bytes - b_bytes : b_bytes - a_bytes;
	size_t row[RECORD_NAME_BYTES_MAX + 1]; /* distances of a's prefix to every prefix of b (Wagner and Fischer 1974) */

	if (gap > most || b_bytes > RECORD_NAME_BYTES_MAX)
		return most + 1;
	for (size_t j = 0; j <= b_bytes; j++)
		row[j] = j;
	for (size_t i = 1; i <= a_bytes; i++) {
		size_t diagonal = row[0], best = row[0] = i;
		for (size_t j = 1; j <= b_bytes; j++) {
			size_t above = row[j];
			size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
			size_t edited = 1 + (above < row[j - 1] ? above : row[j - 1]);
			row[j] = replaced < edited ? replaced : edited;
			diagonal = above;
			best = row[j] < best ? row[j] : best;
		}
		if (best > most)
			return most + 1;
	}
	return row[b_bytes] > most ? most + 1 : row[b_bytes];
}

/* "there is no such material; the nearest is 'X'" */
static void missing_report(const struct selection *selection, const char *name)
{
	struct index_page leaf = {0};
	struct index_entry entry;
	char nearest[RECORD_NAME_BYTES_MAX + 1] = "";
	size_t least = RECORD_NAME_BYTES_MAX;
	bp_error error = {.status = BP_ERROR_NOT_FOUND, .offset = BP_NO_OFFSET};
	uint64_t count = bp_archive_count(selection->archive);

	for (uint64_t i = 0; i < count && least > 0; i++) {
		if (archive_entry(selection->archive, i, &leaf, &entry, NULL))
			break; /* a damaged index: what was seen so far must do */
		size_t distance = name_distance(name, entry.name, least - 1);
		if (distance < least) {
			least = distance;
			memcpy(nearest, entry.name, sizeof nearest);
		}
	}
	if (nearest[0])
		snprintf(error.message, sizeof error.message, "there is no such material; the nearest name is '%s'", nearest);
	else
		snprintf(error.message, sizeof error.message, "there is no such material");
	report_error(selection->path, name, &error);
}

bool selection_open(struct selection *selection, const char *path, char **names, int name_count)
{
	bp_error error;
	*selection = (struct selection){.path = path, .all = name_count == 0};

	if (bp_archive_open(path, &selection->archive, &error)) {
		report_error(path, NULL, &error);
		return false;
	}
	if (selection->all) {
		selection->count = bp_archive_count(selection->archive);
		return true;
	}
	selection->index = malloc((size_t)name_count * sizeof *selection->index);
	if (!selection->index) {
		error_memory(&error, (size_t)name_count * sizeof *selection->index);
		report_error(path, NULL, &error);
		selection_close(selection);
		return false;
	}
	for (int i = 0; i < name_count; i++) {
		bp_status status = bp_archive_find(selection->archive, names[i], &selection->index[selection->count], &error);
		if (!status) {
			selection->count++;
			continue;
		}
		selection->incomplete = true;
		if (status == BP_ERROR_NOT_FOUND)
			missing_report(selection, names[i]);
		else
			report_error(path, names[i], &error);
	}
	return true;
}

void selection_close(struct selection *selection)
{
	bp_archive_close(selection->archive);
	free(selection->index);
	*selection = (struct selection){0};
}

bp_status selection_entry(struct selection *selection, uint64_t n, struct index_entry *entry, bp_error *error)
{
	return archive_entry(selection->archive, selection->all ? n : selection->index[n], &selection->leaf, entry, error);
}
