/*
 * scene.h: which materials a scene file speaks of.
 *
 * pbrt, Mitsuba XML, USD ASCII and JSON all write names, and paths of measured files, between quotes. Any text between two quotes
 * of one kind (" or ', and USD's @), on one line, is a word; what the words mean is not looked at. A word counts as it stands,
 * and as it reads with JSON's backslashes, XML's &references; or a URI's %XX undone.
 */
#ifndef TOOL_SCENE_H
#define TOOL_SCENE_H

#include <stdbool.h>
#include <stddef.h>

#include "brdfpack.h"

struct scene_word {
	char *text;
	const char *file; /* the first that has it: the caller's */
	bool spare;       /* it also reads otherwise, as another word: where this one means nothing, nothing is missing */
};
/* Words of all the files that were added; zeroed to begin with. */
struct scene_words {
	struct scene_word *word;
	size_t count;
};

/*
 * Adds a regular file's words that could be a material's name or a measured file's path; its own path must stay where it is.
 * Errors: BP_ERROR_IO, BP_ERROR_MEMORY.
 */
bp_status scene_words_add(struct scene_words *words, const char *path, bp_error *error);

/* Sorts them by their bytes and removes doubles. */
void scene_words_sort(struct scene_words *words);
void scene_words_free(struct scene_words *words);

#endif
