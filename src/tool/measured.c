#include "measured.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "merl/sha256.h"
#include "report.h"

struct wanted {
	const char **name; /* sorted */
	size_t count;
};

static int ascending(const void *a, const void *b) { return strcmp(*(const char *const *)a, *(const char *const *)b); }

static bool is_wanted(void *user, const char *name)
{
	const struct wanted *wanted = user;
	return bsearch(&name, wanted->name, wanted->count, sizeof *wanted->name, ascending) != NULL;
}

static void notice_show(void *user, enum source_notice kind, const char *path, const char *reason)
{
	(void)user, (void)kind;
	report_warning(path, NULL, "%s", reason);
}

bp_status measured_set_read(struct selection *selection, struct measured_set *out, bp_error *error)
{
	const size_t count = (size_t)selection->count;
	bp_status status = BP_OK;
	*out = (struct measured_set){.item = calloc(count + 1, sizeof *out->item), .name = calloc(count + 1, sizeof *out->name)};
	if (!out->item || !out->name)
		return error_memory(error, count * sizeof *out->item);
	while (out->count < count && !(status = selection_entry(selection, out->count, &out->item[out->count].entry, error))) {
		out->name[out->count] = out->item[out->count].entry.name;
		out->count++;
	}
	return status;
}

bp_status measured_set_find(struct measured_set *set, const char *folder, bp_error *error)
{
	struct wanted wanted = {malloc((set->count + 1) * sizeof *wanted.name), set->count};
	const struct source_options options = {.notice = notice_show, .wanted = is_wanted, .user = &wanted};
	if (!wanted.name)
		return error_memory(error, set->count * sizeof *wanted.name);
	memcpy(wanted.name, set->name, set->count * sizeof *wanted.name);
	qsort(wanted.name, set->count, sizeof *wanted.name, ascending);
	const bp_status status = source_scan(&folder, 1, &options, &set->sources, error);
	free(wanted.name);
	for (size_t s = 0; status == BP_OK && s < set->sources.stream_count; s++)
		report_warning(set->sources.streams[s].path, NULL, "passed over: a compressed tar cannot be searched; unpack it");
	for (size_t n = 0; status == BP_OK && n < set->count; n++)
		set->item[n].source = source_list_find(&set->sources, set->name[n]);
	return status;
}

void measured_set_free(struct measured_set *set)
{
	source_list_free(&set->sources);
	free(set->item);
	free(set->name);
	*set = (struct measured_set){0};
}

bp_status measured_read(const struct source_item *source, struct source_cursor *cursor, const struct record_head *head,
                        struct lattice *out, bool *packed, bp_error *error)
{
	struct sha256 sha;
	uint8_t digest[SHA256_BYTES];
	const struct merl_reading reading = {.seen = packed ? sha256_add : NULL, .seen_user = &sha, .any_dims = true};
	struct holes holes;
	bp_error reason;

	sha256_start(&sha);
	bp_status status = source_item_read(source, cursor, &reading, out, &reason);
	if (!status && (status = lattice_take_holes(out, head->options.zeros, &holes, &reason)))
		lattice_free(out);
	if (status)
		return error_set(error, status, reason.offset, "%s: %s", source->path, reason.message);
	sha256_finish(&sha, digest);
	if (packed)
		*packed = memcmp(digest, head->source.sha256, sizeof digest) == 0;
	return BP_OK;
}
