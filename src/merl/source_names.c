#include "source_names.h"

#include <search.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "name.h"
#include "shown.h"

/* Who has a name: where it was first seen. */
struct claim {
	char *name, *where;
};

static int claim_compare(const void *a, const void *b)
{
	return strcmp(((const struct claim *)a)->name, ((const struct claim *)b)->name);
}

static void claim_free(void *claim)
{
	free(((struct claim *)claim)->name);
	free(((struct claim *)claim)->where);
	free(claim);
}

char *source_text_shown(const char *text)
{
	const size_t room = 4 * strlen(text) + 8;
	char *shown = malloc(room);
	if (shown)
		shown_text(shown, room, text);
	return shown;
}

bp_status source_name_make(const char *path, const char *member, const char *fault, char name[SOURCE_STEM_BYTES], bp_error *error)
{
	source_stem(member ? member : path, name);
	const char *illegal = name_fault(name, strlen(name));
	if (illegal)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "its stem cannot name a material: %s; %s", illegal,
		                 member && !name_text(name)
		                     ? "tell the names' character set with --charset (CP437, SHIFT_JIS, ISO-8859-1 ...)"
		                     : "rename the file");
	return fault ? error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s", fault) : BP_OK;
}

bp_status source_name_claim(void **names, const char *name, const char *path, const char *member, bp_error *error)
{
	struct claim *claim = calloc(1, sizeof *claim);
	if (claim)
		claim->name = strdup(name);
	if (claim && asprintf(&claim->where, "%s%s%s", path, member ? ": member " : "", member ? member : "") < 0)
		claim->where = NULL;
	struct claim **holder = claim && claim->name && claim->where ? tsearch(claim, names, claim_compare) : NULL;
	if (holder && *holder == claim)
		return BP_OK;
	if (claim)
		claim_free(claim);
	if (!holder)
		return error_memory(error, sizeof *claim);
	return error_argument(error, "two materials named %s: %.300s has the name; rename or leave out one", name, (*holder)->where);
}

void source_names_free(void *names) { tdestroy(names, claim_free); }
