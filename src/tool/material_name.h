/*
 * material_name.h: a material's name as people write it: as it is, or as the measured file's, NAME.binary, FOLDER/NAME.binary.
 */
#ifndef TOOL_MATERIAL_NAME_H
#define TOOL_MATERIAL_NAME_H

#include <stdbool.h>

#include "brdfpack.h"

/*
 * The names that `written` may mean, from the most literal on: form 0, 1, ... MATERIAL_NAME_FORMS - 1. False where a form is no
 * legal name. Several may be the same.
 */
enum { MATERIAL_NAME_FORMS = 6 };
bool material_name_form(const char *written, unsigned form, char name[BP_NAME_BYTES_MAX + 1]);

/* The least literal form: without path and suffix. False: it is no legal name. */
bool material_name_bare(const char *written, char name[BP_NAME_BYTES_MAX + 1]);

/* bp_archive_find for the first form that is there. BP_ERROR_NOT_FOUND: none is. */
bp_status material_name_find(const bp_archive *archive, const char *written, uint64_t *index, bp_error *error);

#endif
