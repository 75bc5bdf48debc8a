/*
 * shown.h: text from outside, names and paths, on its way to people. Internal.
 *
 * A terminal obeys control characters of 7 and 8 bits, and bidirectional and invisible ones make a name look like another.
 * What is one of these, or no UTF-8, is shown as \xHH for each of its bytes; all else as it is.
 */
#ifndef SHOWN_H
#define SHOWN_H

#include <stddef.h>

enum { SHOWN_STEP_MAX = 16 }; /* bytes that one character takes at most: four, escaped */

/*
 * The next character of the text at *from, NUL-terminated: writes what is shown of it to out[SHOWN_STEP_MAX], without a NUL, and
 * returns its bytes; moves *from behind it. 0 at the end. *columns (NULL: not asked) is how wide a terminal shows it: 0 to 2
 * for a character, 4 for an escaped byte.
 */
size_t shown_next(const char **from, char out[SHOWN_STEP_MAX], int *columns);

/* All of the text to to[room], NUL-terminated, cut between characters where it is full. Returns its bytes. */
size_t shown_text(char *to, size_t room, const char *from);

/* How many columns of a terminal the text takes when it is shown. */
int shown_columns(const char *text);

#endif
