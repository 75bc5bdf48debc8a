/*
 * normal_form.h: one text, two spellings in Unicode. A Mac decomposes the letters of file names ("u" and a mark for "ü"),
 * keyboards compose them.
 */
#ifndef MERL_NORMAL_FORM_H
#define MERL_NORMAL_FORM_H

#include <stdbool.h>
#include <stddef.h>

/*
 * Whether two different texts are spellings of one: the same with every letter taken apart into its base and marks (canonical
 * decomposition; the order of marks is left as it is). What is not UTF-8 stays as it is. False without memory.
 */
bool normal_form_equal(const char *a, const char *b);

/* Texts to be recognised in another spelling; zeroed to begin with. ASCII has one spelling only, and is not kept. */
struct normal_forms {
	struct normal_form_entry {
		char *form;
		size_t number;
	} * entry;
	size_t count;
	bool sorted;
};

/* Adds a text with a number of the caller's. A hint is all that hangs on it: without memory it is left out. */
void normal_forms_add(struct normal_forms *forms, const char *text, size_t number);

/* The number of a text that this is another (or the same) spelling of. False: there is none. */
bool normal_forms_find(struct normal_forms *forms, const char *text, size_t *number);
void normal_forms_free(struct normal_forms *forms);

#endif
