#include "normal_form.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <uchar.h>

#include "memory.h"
#include "name.h"

enum { NORMAL_BYTES = 4096 };

static const struct {
	uint16_t mark;
	const char16_t *pairs;
} MARKS[] = {
#include "normal_form.inc.h"
};

struct decomposition {
	uint16_t composed, base, mark;
};

static int composed_compare(const void *a, const void *b)
{
	return ((const struct decomposition *)a)->composed - ((const struct decomposition *)b)->composed;
}

static const struct decomposition *decomposition_find(uint32_t code)
{
	static struct decomposition all[1100]; /* by composed character, once one is asked for */
	static size_t count;
	if (count == 0) {
		for (size_t m = 0; m < sizeof MARKS / sizeof *MARKS; m++)
			for (const char16_t *pair = MARKS[m].pairs; *pair; pair += 2)
				all[count++] = (struct decomposition){pair[0], pair[1], MARKS[m].mark};
		qsort(all, count, sizeof *all, composed_compare);
	}
	const struct decomposition key = {.composed = (uint16_t)code};
	return code > UINT16_MAX ? NULL : bsearch(&key, all, count, sizeof *all, composed_compare);
}

struct text {
	char *bytes;
	size_t used, room;
	bool full;
};

static void byte_put(struct text *text, uint32_t byte)
{
	text->full |= text->used + 1 >= text->room;
	if (!text->full)
		text->bytes[text->used++] = (char)byte;
}

static void code_put(struct text *text, uint32_t code)
{
	static const uint8_t LEAD[] = {0, 0xC0, 0xE0, 0xF0};
	const uint32_t more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
	byte_put(text, LEAD[more] | code >> (6 * more));
	for (uint32_t n = more; n-- > 0;)
		byte_put(text, 0x80 | (code >> (6 * n) & 0x3F));
}

/* Bases are decomposed in turn, marks are not composed. */
static void code_decompose(struct text *text, uint32_t code)
{
	enum { HANGUL = 0xAC00, HANGUL_COUNT = 11172, L = 0x1100, V = 0x1161, T = 0x11A7, V_COUNT = 21, T_COUNT = 28 };
	if (code >= HANGUL && code < HANGUL + HANGUL_COUNT) {
		const uint32_t n = code - HANGUL;
		code_put(text, L + n / (V_COUNT * T_COUNT));
		code_put(text, V + n / T_COUNT % V_COUNT);
		if (n % T_COUNT)
			code_put(text, T + n % T_COUNT);
		return;
	}
	uint32_t marks[8];
	size_t count = 0;
	for (const struct decomposition *found; count < 8 && (found = decomposition_find(code));) {
		code = found->base;
		if (found->mark)
			marks[count++] = found->mark;
	}
	code_put(text, code);
	while (count)
		code_put(text, marks[--count]);
}

bool normal_form(const char *text, char *out, size_t room)
{
	struct text form = {.bytes = out, .room = room};
	const uint8_t *at = (const uint8_t *)text;
	for (size_t left = strlen(text), step; left > 0 && !form.full; at += step, left -= step) {
		uint32_t code = 0;
		step = name_character(at, left, &code);
		if (step)
			code_decompose(&form, code);
		else
			byte_put(&form, at[0]);
		step += !step;
	}
	out[form.used] = '\0';
	return !form.full;
}

static bool is_ascii(const char *text)
{
	while (*text && (uint8_t)*text < 0x80)
		text++;
	return !*text;
}

bool normal_form_equal(const char *a, const char *b)
{
	char x[NORMAL_BYTES], y[NORMAL_BYTES];
	return !is_ascii(a) && !is_ascii(b) && strcmp(a, b) != 0 && normal_form(a, x, sizeof x) && normal_form(b, y, sizeof y) &&
	       !strcmp(x, y);
}

void normal_forms_add(struct normal_forms *forms, const char *text, size_t number)
{
	char form[NORMAL_BYTES];
	if (is_ascii(text) || !normal_form(text, form, sizeof form))
		return;
	struct normal_form_entry *entry = memory_grown(forms->entry, forms->count, sizeof *entry);
	if (!entry)
		return;
	forms->entry = entry;
	char *copy = strdup(form);
	if (copy)
		forms->entry[forms->count++] = (struct normal_form_entry){.form = copy, .number = number};
	forms->sorted = false;
}

static int entry_compare(const void *a, const void *b)
{
	return strcmp(((const struct normal_form_entry *)a)->form, ((const struct normal_form_entry *)b)->form);
}

bool normal_forms_find(struct normal_forms *forms, const char *text, size_t *number)
{
	char form[NORMAL_BYTES];
	if (forms->count == 0 || is_ascii(text) || !normal_form(text, form, sizeof form))
		return false;
	if (!forms->sorted)
		qsort(forms->entry, forms->count, sizeof *forms->entry, entry_compare);
	forms->sorted = true;
	const struct normal_form_entry key = {.form = form};
	const struct normal_form_entry *found = bsearch(&key, forms->entry, forms->count, sizeof key, entry_compare);
	if (found)
		*number = found->number;
	return found;
}

void normal_forms_free(struct normal_forms *forms)
{
	for (size_t n = 0; n < forms->count; n++)
		free(forms->entry[n].form);
	free(forms->entry);
	*forms = (struct normal_forms){0};
}
