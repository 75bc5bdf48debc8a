#include "measured.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
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

bp_status measured_find(const char *folder, const char *const *names, size_t count, struct source_list *out, bp_error *error)
{
	struct wanted wanted = {malloc((count + 1) * sizeof *wanted.name), count};
	const struct source_options options = {.notice = notice_show, .wanted = is_wanted, .user = &wanted};
	if (!wanted.name)
		return error_memory(error, count * sizeof *wanted.name);
	memcpy(wanted.name, names, count * sizeof *wanted.name);
	qsort(wanted.name, count, sizeof *wanted.name, ascending);
	const bp_status status = source_scan(&folder, 1, &options, out, error);
	for (size_t s = 0; status == BP_OK && s < out->stream_count; s++)
		report_warning(out->streams[s], NULL, "passed over: a compressed tar cannot be searched; unpack it");
	free(wanted.name);
	return status;
}
