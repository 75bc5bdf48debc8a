#include "spelling.h"

#include <stdbool.h>
#include <string.h>

#include "normal_form.h"

enum { BEGINNING_LEAST = 3 };

static unsigned char folded(char letter)
{
	const unsigned char byte = (unsigned char)letter;
	return byte >= 'A' && byte <= 'Z' ? (unsigned char)(byte + 32) : byte;
}

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* Optimal string alignment distance, or `limit` when it is not less. Both lengths <= SPELLING_BYTES_MAX. */
static size_t spelling_distance(const char *a, const char *b, size_t limit)
{
	const size_t a_count = strlen(a), b_count = strlen(b);
	const size_t apart = a_count > b_count ? a_count - b_count : b_count - a_count;
	if (apart >= limit)
		return limit;
	size_t rows[3][SPELLING_BYTES_MAX + 1]; /* two rows back, one back, this one */
	size_t *before = rows[0], *previous = rows[1], *row = rows[2];
	for (size_t n = 0; n <= b_count; n++)
		previous[n] = n;
	for (size_t m = 1; m <= a_count; m++) {
		size_t lowest = row[0] = m;
		for (size_t n = 1; n <= b_count; n++) {
			const bool same = folded(a[m - 1]) == folded(b[n - 1]);
			row[n] = least(previous[n - 1] + !same, least(previous[n], row[n - 1]) + 1);
			if (m > 1 && n > 1 && folded(a[m - 1]) == folded(b[n - 2]) && folded(a[m - 2]) == folded(b[n - 1]))
				row[n] = least(row[n], before[n - 2] + 1);
			lowest = least(lowest, row[n]);
		}
		if (lowest > limit) /* more than: an exchange may still reach one less from the row before */
			return limit;
		size_t *spare = before;
		before = previous;
		previous = row;
		row = spare;
	}
	return least(previous[b_count], limit);
}

/* Is `name` the beginning of `whole`? */
static bool begins(const char *name, const char *whole)
{
	while (*name && folded(*name) == folded(*whole)) {
		name++;
		whole++;
	}
	return !*name;
}

void name_guess_start(struct name_guess *guess, const char *wanted)
{
	const size_t letters = strlen(wanted);
	guess->wanted = wanted;
	guess->best[0] = '\0';
	guess->limit = guess->distance = letters > SPELLING_BYTES_MAX ? 0 : (letters < 6 ? 2 : letters / 3) + 1;
}

void name_guess_offer(struct name_guess *guess, const char *candidate)
{
	const size_t bytes = strlen(candidate);
	if (guess->best[0] && !guess->distance)
		return;
	if (!bytes || bytes > SPELLING_BYTES_MAX)
		return;
	if (normal_form_equal(guess->wanted, candidate)) {
		guess->distance = 0; /* nothing is nearer */
		memcpy(guess->best, candidate, bytes + 1);
		return;
	}
	if (!guess->limit)
		return;
	size_t distance = spelling_distance(guess->wanted, candidate, guess->distance);
	if (strlen(guess->wanted) >= BEGINNING_LEAST && begins(guess->wanted, candidate))
		distance = least(distance, guess->limit - 1); /* as far as a guess may be */
	if (distance < guess->distance) {
		guess->distance = distance;
		memcpy(guess->best, candidate, bytes + 1);
	}
}

const char *name_guess_best(const struct name_guess *guess) { return guess->best[0] ? guess->best : NULL; }
