/*
 * material_name.h: a material's name as people write it: as it is, or as the measured file's, NAME.binary, FOLDER/NAME.binary.
 */
#ifndef TOOL_MATERIAL_NAME_H
#define TOOL_MATERIAL_NAME_H

#include <stdbool.h>

#include "brdfpack.h"

/* Without path and suffix. False: it is no legal name. */
bool material_name_bare(const char *written, char name[BP_NAME_BYTES_MAX + 1]);

/* bp_archive_find for what `written` may mean, from the most literal on: the first that is there. BP_ERROR_NOT_FOUND: none is. */
bp_status material_name_find(const bp_archive *archive, const char *written, uint64_t *index, bp_error *error);

#endif
