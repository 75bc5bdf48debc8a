#include "selection.h"

#include "error.h"
#include "merl/normal_form.h"
#include "merl/source_kind.h"
#include "merl/spelling.h"
#include "name.h"
#include "render/comparison.h"
#include "report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The forms from the most literal on; false where one is no legal name. Several may be the same. */
enum { FORMS = 6 };
static bool name_form(const char *written, unsigned form, char name[BP_NAME_BYTES_MAX + 1])
{
	static const char *const SEPARATORS[] = {"", "/", "/\\"};
	const char *start = written;
	for (const char *at = written; *at; at++)
		if (strchr(SEPARATORS[form / 2], *at))
			start = at + 1;
	const size_t bytes = strlen(start) - (form % 2 ? source_suffix_bytes(start) : 0);
	if (name_fault(start, bytes))
		return false;
	memcpy(name, start, bytes);
	name[bytes] = '\0';
	return true;
}

bool selection_name_bare(const char *written, char name[BP_NAME_BYTES_MAX + 1]) { return name_form(written, 3, name); }

bp_status selection_name_find(const bp_archive *archive, const char *written, uint64_t *index, bp_error *error)
{
	char name[BP_NAME_BYTES_MAX + 1], before[BP_NAME_BYTES_MAX + 1] = "";
	for (unsigned form = 0; form < FORMS; form++) {
		if (!name_form(written, form, name) || !strcmp(name, before))
			continue;
		const bp_status status = bp_archive_find(archive, name, index, error);
		if (status != BP_ERROR_NOT_FOUND)
			return status;
		strcpy(before, name);
	}
	return error_set(error, BP_ERROR_NOT_FOUND, BP_NO_OFFSET, "there is no such material");
}

void selection_missing_report(const struct selection *selection, const char *written, const char *where)
{
	char name[BP_NAME_BYTES_MAX + 1];
	struct index_page leaf = {0};
	struct index_entry entry;
	struct name_guess guess;
	bp_error error = {.status = BP_ERROR_NOT_FOUND, .offset = BP_NO_OFFSET};
	uint64_t count = bp_archive_count(selection->archive);

	if (!selection_name_bare(written, name))
		name[0] = '\0';
	name_guess_start(&guess, name);
	for (uint64_t i = 0; i < count; i++) {
		if (archive_entry(selection->archive, i, &leaf, &entry, NULL))
			break; /* a damaged index: what was seen so far must do */
		name_guess_offer(&guess, entry.name);
	}
	const char *best = name_guess_best(&guess);
	const char *after = !best ? "; `brdfpack list` shows what is there"
	                    : !normal_form_equal(name, best)
	                        ? "'?"
	                        : "'? It is the same text in another Unicode form "
	                          "(letters and accents apart, or composed): copy it from `brdfpack list`";
	snprintf(error.message, sizeof error.message, "there is no such material%s%.150s%s%s%s", where ? ", which is named in " : "",
	         where ? where : "", best ? "; did you mean '" : "", best ? best : "", after);
	report_error(selection->path, written, &error);
}

/* A name that is written twice means its material once. */
static bool is_selected(const struct selection *selection, uint64_t index)
{
	for (uint64_t n = 0; n < selection->count; n++)
		if (selection->index[n] == index)
			return true;
	return false;
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
		bp_status status = selection_name_find(selection->archive, names[i], &selection->index[selection->count], &error);
		if (!status) {
			selection->count += !is_selected(selection, selection->index[selection->count]);
			continue;
		}
		selection->incomplete = true;
		if (status == BP_ERROR_NOT_FOUND)
			selection_missing_report(selection, names[i], NULL);
		else
			report_error(path, names[i], &error);
	}
	return true;
}

int selection_from(struct selection *selection, const struct command *command, char **operands, int operand_count)
{
	if (operand_count < 1)
		return report_usage(command, "no archive");
	return selection_open(selection, operands[0], operands + 1, operand_count - 1) ? EXIT_OK : EXIT_FAILED;
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

bool selection_head(struct selection *selection, uint64_t n, struct index_entry *entry, struct record_head *head)
{
	bp_error error;
	*entry = (struct index_entry){.name = ""};
	const bp_status status = selection_entry(selection, n, entry, &error);
	if (!status && !archive_entry_head(selection->archive, entry, head, &error))
		return true;
	if (status && selection->all) /* one message, not one for every material that the header promises */
		selection->count = n;
	report_error(selection->path, entry->name[0] ? entry->name : NULL, &error);
	return false;
}

bp_status selection_plans_make(struct selection *selection, struct comparison_plans *plans, bp_error *error)
{
	struct index_entry entry;
	struct record_head head;
	for (uint64_t n = 0; n < selection->count && selection_entry(selection, n, &entry, NULL) == BP_OK; n++)
		if (archive_entry_head(selection->archive, &entry, &head, NULL) == BP_OK)
			return comparison_plans_make(plans, head.dims, error);
	return BP_OK;
}
