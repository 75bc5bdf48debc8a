#include "licence.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "name.h"
#include "source_names.h"

static bool is_licence(const char *path)
{
	static const char *const BEGINNINGS[] = {"copying", "copyright", "notice", "terms"};
	const char *name = name_in_path(path);
	for (size_t n = 0; n < sizeof BEGINNINGS / sizeof *BEGINNINGS; n++)
		if (strncasecmp(name, BEGINNINGS[n], strlen(BEGINNINGS[n])) == 0)
			return true;
	return strcasestr(name, "license") || strcasestr(name, "licence");
}

void licences_note(struct licences *licences, const char *path, const char *member)
{
	if (!is_licence(member ? member : path) || licences->count == LICENCES_MAX)
		return;
	char *shown = source_text_shown(member ? member : path), *whole = NULL;
	if (shown && member && asprintf(&whole, "%s: %s", path, shown) >= 0) {
		free(shown);
		shown = whole;
	}
	for (size_t n = 0; shown && n < licences->count; n++)
		if (!strcmp(licences->path[n], shown)) { /* of an input that was given twice */
			free(shown);
			shown = NULL;
		}
	if (shown)
		licences->path[licences->count++] = shown;
}

void licences_free(struct licences *licences)
{
	while (licences->count > 0)
		free(licences->path[--licences->count]);
}
