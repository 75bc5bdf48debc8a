#include "scene.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "name.h"
#include "error.h"
#include "memory.h"

static bp_status word_add(struct scene_words *words, const char *text, size_t bytes, bool spare, bp_error *error)
{
	struct scene_word *word = memory_grown(words->word, words->count, sizeof *word);
	if (!word)
		return error_memory(error, words->count * sizeof *word);
	words->word = word;
	char *copy = strndup(text, bytes);
	if (!copy)
		return error_memory(error, bytes);
	words->word[words->count++] = (struct scene_word){.text = copy, .spare = spare};
	return BP_OK;
}

/* A word as it stands in the file: a path with escapes. */
enum { WORD_BYTES_MAX = 8192 };

/* What a word means. */
struct meaning {
	char text[WORD_BYTES_MAX];
	size_t bytes;
};

static void character_put(struct meaning *to, uint32_t code)
{
	const uint8_t lead[] = {0, 0xC0, 0xE0, 0xF0};
	const uint32_t more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
	to->text[to->bytes++] = (char)(lead[more] | code >> (6 * more));
	for (uint32_t n = more; n-- > 0;)
		to->text[to->bytes++] = (char)(0x80 | (code >> (6 * n) & 0x3F));
}

/* The number at the beginning of the text; how many digits it has, 0 where there is none or where it is no character. */
static size_t number_take(const char *text, size_t bytes, uint32_t base, size_t digits_max, uint32_t *number)
{
	size_t n = 0;
	*number = 0;
	for (; n < bytes && n < digits_max; n++) {
		const uint32_t c = (uint8_t)text[n], letter = c | 0x20;
		const uint32_t digit = c >= '0' && c <= '9' ? c - '0' : letter >= 'a' && letter <= 'f' ? letter - 'a' + 10 : base;
		if (digit >= base)
			break;
		*number = *number * base + digit;
	}
	return *number > 0 && *number <= 0x10FFFF ? n : 0;
}

/* JSON's \" \\ \/ \uXXXX, and \' which others have; false for those of control characters, which stand in no name. */
static bool backslashes_read(const char *text, size_t bytes, struct meaning *to)
{
	to->bytes = 0;
	for (size_t at = 0; at < bytes; at++) {
		uint32_t code, low;
		if (text[at] != '\\') {
			to->text[to->bytes++] = text[at];
		} else if (++at < bytes && text[at] == 'u') {
			if (number_take(text + at + 1, bytes - at - 1, 16, 4, &code) != 4)
				return false;
			at += 4;
			/* beyond U+FFFF two halves, each written so */
			if (code >= 0xD800 && code < 0xDC00 && bytes - at > 6 && text[at + 1] == '\\' && text[at + 2] == 'u' &&
			    number_take(text + at + 3, bytes - at - 3, 16, 4, &low) == 4 && low >= 0xDC00 && low < 0xE000) {
				code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
				at += 6;
			}
			character_put(to, code);
		} else if (at < bytes && strchr("\"\\/'", text[at])) {
			to->text[to->bytes++] = text[at];
		} else {
			return false;
		}
	}
	return true;
}

/* XML's references to characters; what is none stays as it is. */
static void references_read(const char *text, size_t bytes, struct meaning *to)
{
	static const struct {
		const char *name;
		char means;
	} NAMED[] = {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
	enum { NAMED_COUNT = sizeof NAMED / sizeof *NAMED };
	to->bytes = 0;
	for (size_t at = 0; at < bytes;) {
		const size_t left = bytes - at;
		size_t n = 0, digits;
		uint32_t code;
		while (n < NAMED_COUNT && (left < strlen(NAMED[n].name) || memcmp(text + at, NAMED[n].name, strlen(NAMED[n].name)) != 0))
			n++;
		if (n < NAMED_COUNT) {
			to->text[to->bytes++] = NAMED[n].means;
			at += strlen(NAMED[n].name);
		} else if (left > 3 && !memcmp(text + at, "&#", 2)) {
			const size_t start = text[at + 2] == 'x' ? 3 : 2;
			digits = number_take(text + at + start, left - start, start == 3 ? 16 : 10, 7, &code);
			if (digits > 0 && start + digits < left && text[at + start + digits] == ';') {
				character_put(to, code);
				at += start + digits + 1;
			} else {
				to->text[to->bytes++] = text[at++];
			}
		} else {
			to->text[to->bytes++] = text[at++];
		}
	}
}

/*
 * The text since the last quote of one kind; too long to be a name, or past a line's end, it is none. A quote may open
 * a word, close one, or be an apostrophe: so each ends one and begins another. One behind a backslash may be part of
 * the word, or the backslash may be: so both are tried, the first by the second pair of open words.
 */
struct open_word {
	char text[WORD_BYTES_MAX];
	size_t bytes;
	bool possible;
	bool backslash; /* the last byte is one that stands for no other */
};

/* Adds what may name a material or its measured file: the last part of a path must be legal. */
static bp_status name_add(struct scene_words *words, const char *text, size_t bytes, bool spare, bp_error *error)
{
	const char *slash = memrchr(text, '/', bytes), *last = slash ? slash + 1 : text;
	const char *back = memrchr(text, '\\', bytes), *windows = back ? back + 1 : text;
	const size_t left = bytes - (size_t)(last - text), windows_left = bytes - (size_t)(windows - text);
	return memchr(text, 0, bytes) || (name_fault(last, left) && name_fault(windows, windows_left))
	           ? BP_OK
	           : word_add(words, text, bytes, spare, error);
}

/* A URI's %XX; what is none stays as it is. */
static void percents_read(const char *text, size_t bytes, struct meaning *to)
{
	to->bytes = 0;
	for (size_t at = 0; at < bytes; at++) {
		uint32_t byte;
		if (text[at] == '%' && bytes - at > 2 && number_take(text + at + 1, bytes - at - 1, 16, 2, &byte) == 2) {
			to->text[to->bytes++] = (char)byte;
			at += 2;
		} else {
			to->text[to->bytes++] = text[at];
		}
	}
}

static bool differs(const struct open_word *word, const struct meaning *meaning)
{
	return meaning->bytes != word->bytes || memcmp(meaning->text, word->text, word->bytes) != 0;
}

/* Adds the word, and what it means if it has escapes. */
static bp_status word_close(struct scene_words *words, const struct open_word *word, bool escapes, bp_error *error)
{
	struct meaning plain, reference, percent;
	const bool backslashes = memchr(word->text, '\\', word->bytes) && backslashes_read(word->text, word->bytes, &plain);
	if (escapes)
		return backslashes ? name_add(words, plain.text, plain.bytes, false, error) : BP_OK;
	references_read(word->text, word->bytes, &reference);
	percents_read(word->text, word->bytes, &percent);
	const bool by_reference = differs(word, &reference), by_percent = differs(word, &percent);
	bp_status status = name_add(words, word->text, word->bytes, backslashes || by_reference || by_percent, error);
	if (!status && by_reference)
		status = name_add(words, reference.text, reference.bytes, false, error);
	if (!status && by_percent)
		status = name_add(words, percent.text, percent.bytes, false, error);
	return status;
}

static bp_status quotes_scan(struct scene_words *words, FILE *file, bp_error *error)
{
	static const struct {
		char mark;
		bool escapes;
	} KINDS[] = {{'"', false}, {'\'', false}, {'@', false}, {'"', true}, {'\'', true}};
	enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };
	struct open_word open[KIND_COUNT] = {{.possible = false}};
	bp_status status = BP_OK;
	int c;

	while (!status && (c = getc_unlocked(file)) != EOF)
		for (int kind = 0; kind < KIND_COUNT && !status; kind++) {
			struct open_word *word = &open[kind];
			const bool escapes = KINDS[kind].escapes, escaped = escapes && word->backslash;
			word->backslash = c == '\\' && !escaped;
			if (c == KINDS[kind].mark && !escaped) {
				if (word->possible)
					status = word_close(words, word, escapes, error);
				word->bytes = 0;
				word->possible = true;
			} else if (word->bytes == WORD_BYTES_MAX || c == '\n' || c == 0) {
				word->possible = false;
			} else {
				word->text[word->bytes++] = (char)c;
			}
		}
	return status;
}

bp_status scene_words_add(struct scene_words *words, const char *path, bp_error *error)
{
	struct stat about;
	int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a FIFO must not hang */
	if (fd < 0)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot open: %s", strerror(errno));
	if (fstat(fd, &about) != 0 || !S_ISREG(about.st_mode)) {
		close(fd);
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "not a regular file");
	}
	FILE *file = fdopen(fd, "r");
	if (!file) {
		close(fd);
		return error_memory(error, sizeof *file);
	}
	const size_t before = words->count;
	bp_status status = quotes_scan(words, file, error);
	for (size_t n = before; n < words->count; n++)
		words->word[n].file = path;
	if (!status && ferror(file))
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot read: %s", strerror(errno));
	fclose(file);
	return status;
}

static int ascending(const void *a, const void *b)
{
	return strcmp(((const struct scene_word *)a)->text, ((const struct scene_word *)b)->text);
}

void scene_words_sort(struct scene_words *words)
{
	size_t kept = 0;
	if (words->count == 0)
		return;
	qsort(words->word, words->count, sizeof *words->word, ascending);
	for (size_t n = 0; n < words->count; n++)
		if (kept > 0 && !strcmp(words->word[kept - 1].text, words->word[n].text)) {
			words->word[kept - 1].spare &= words->word[n].spare;
			free(words->word[n].text);
		} else {
			words->word[kept++] = words->word[n];
		}
	words->count = kept;
}

void scene_words_free(struct scene_words *words)
{
	for (size_t n = 0; n < words->count; n++)
		free(words->word[n].text);
	free(words->word);
	*words = (struct scene_words){0};
}
