/*
 * measured.h: the measured files that belong to an archive's materials, by their names.
 */
#ifndef TOOL_MEASURED_H
#define TOOL_MEASURED_H

#include "merl/source.h"

/*
 * Searches a folder (or zip) for files of these names; the caller looks them up by source_list_find and frees the list. What is passed
 * over has been said.
 */
bp_status measured_find(const char *folder, const char *const *names, size_t count, struct source_list *out, bp_error *error);

#endif
