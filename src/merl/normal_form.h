/*
 * normal_form.h: one text, two spellings in Unicode. A Mac decomposes the letters of file names ("u" and a mark for "ü"),
 * keyboards compose them.
 */
#ifndef MERL_NORMAL_FORM_H
#define MERL_NORMAL_FORM_H

#include <stdbool.h>
#include <stddef.h>

/*
 * The text with every letter taken apart into its base and marks (canonical decomposition; the order of marks is left as it is),
 * in out[room], NUL-terminated. What is not UTF-8 stays as it is. False when there is no room.
 */
bool normal_form(const char *text, char *out, size_t room);

/* Whether two different texts are spellings of one. */
bool normal_form_equal(const char *a, const char *b);

#endif
