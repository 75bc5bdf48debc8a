/*
 * spelling.h: which name was probably meant when one is not there.
 */
#ifndef MERL_SPELLING_H
#define MERL_SPELLING_H

#include <stddef.h>

enum { SPELLING_BYTES_MAX = 255 };

/*
 * The nearest spelling: fewest letters inserted, removed, replaced or exchanged with their
 * neighbour; ASCII case counts nothing. A name that begins with the wanted one (three letters or more) is
 * near too, but less so; the same text in another Unicode form is nearest. Start with the name that was not found, offer every
 * name there is (the first of equals wins), then ask.
 */
struct name_guess {
	const char *wanted; /* the caller's, for as long as the guess lives */
	size_t distance, limit;
	char best[SPELLING_BYTES_MAX + 1];
};
void name_guess_start(struct name_guess *guess, const char *wanted);
void name_guess_offer(struct name_guess *guess, const char *candidate);
/* NULL when nothing is near: a third of the letters (two in short names) may differ. */
const char *name_guess_best(const struct name_guess *guess);

#endif
