#include "scene.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../codec/name.h"
#include "../error.h"

static bp_status word_add(struct scene_words *words, const char *text, size_t bytes, bp_error *error)
{
	if (words->count == words->room) {
		size_t room = words->room ? 2 * words->room : 64;
		char **word = realloc(words->word, room * sizeof *word);
		if (!word)
			return error_memory(error, room * sizeof *word);
		words->word = word;
		words->room = room;
	}
	char *copy = strndup(text, bytes);
	if (!copy)
		return error_memory(error, bytes);
	words->word[words->count++] = copy;
	return BP_OK;
}

/*
 * The text since the last quote of one kind; too long to be a name, or past a line's end, it is none. A quote may open
 * a word, close one, or be an apostrophe: so each ends one and begins another.
 */
struct open_word {
	char text[BP_NAME_BYTES_MAX + 1];
	size_t bytes;
	bool possible;
};

static bp_status quotes_scan(struct scene_words *words, FILE *file, bp_error *error)
{
	struct open_word open[2] = {{.possible = false}, {.possible = false}};
	bp_status status = BP_OK;
	int c;

	while (!status && (c = getc_unlocked(file)) != EOF)
		for (int kind = 0; kind < 2 && !status; kind++) {
			struct open_word *word = &open[kind];
			if (c == (kind ? '\'' : '"')) {
				if (word->possible && !name_fault(word->text, word->bytes))
					status = word_add(words, word->text, word->bytes, error);
				word->bytes = 0;
				word->possible = true;
			} else if (word->bytes == BP_NAME_BYTES_MAX || c == '\n' || c == 0) {
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
	bp_status status = quotes_scan(words, file, error);
	if (!status && ferror(file))
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot read: %s", strerror(errno));
	fclose(file);
	return status;
}

static int ascending(const void *a, const void *b)
{
	return strcmp(*(char *const *)a, *(char *const *)b);
}

void scene_words_sort(struct scene_words *words)
{
	size_t kept = 0;
	if (words->count == 0)
		return;
	qsort(words->word, words->count, sizeof *words->word, ascending);
	for (size_t n = 0; n < words->count; n++)
		if (kept > 0 && !strcmp(words->word[kept - 1], words->word[n]))
			free(words->word[n]);
		else
			words->word[kept++] = words->word[n];
	words->count = kept;
}

void scene_words_free(struct scene_words *words)
{
	for (size_t n = 0; n < words->count; n++)
		free(words->word[n]);
	free(words->word);
	*words = (struct scene_words){0};
}
