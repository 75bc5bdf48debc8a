/*
 * source_names.h: what the things that were found are called, and who has which name.
 */
#ifndef MERL_SOURCE_NAMES_H
#define MERL_SOURCE_NAMES_H

#include "brdfpack.h"
#include "source_kind.h"

/* What is shown of a name or path that need not be legal text: the rest as \xHH; malloc'ed, NULL without memory. */
char *source_text_shown(const char *text);

/*
 * What a file, or a member, would be called. BP_ERROR_BAD_INPUT: it cannot be packed, because the name is illegal or because of
 * `fault` (NULL: none); the name is there all the same.
 */
bp_status source_name_make(const char *path, const char *member, const char *fault, char name[SOURCE_STEM_BYTES],
                           bp_error *error);

/* Takes the name for a file or member; *names is NULL at first. BP_ERROR_ARGUMENT: another one has it, the message says which. */
bp_status source_name_claim(void **names, const char *name, const char *path, const char *member, bp_error *error);
void source_names_free(void *names);

#endif
