#include "material_name.h"

#include <string.h>

#include "merl/source_kind.h"
#include "name.h"
#include "error.h"

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

bool material_name_bare(const char *written, char name[BP_NAME_BYTES_MAX + 1]) { return name_form(written, 3, name); }

bp_status material_name_find(const bp_archive *archive, const char *written, uint64_t *index, bp_error *error)
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
