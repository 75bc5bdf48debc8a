#include "normal_form.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <uchar.h>

#include "bytes.h"
#include "memory.h"
#include "name.h"

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

static void code_put(struct byte_buffer *out, uint32_t code)
{
	static const uint8_t LEAD[] = {0, 0xC0, 0xE0, 0xF0};
	const uint32_t more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
	write_u8(out, (uint8_t)(LEAD[more] | code >> (6 * more)));
	for (uint32_t n = more; n-- > 0;)
		write_u8(out, (uint8_t)(0x80 | (code >> (6 * n) & 0x3F)));
}

/* Bases are decomposed in turn, marks are not composed. */
static void code_decompose(struct byte_buffer *out, uint32_t code)
{
	enum { HANGUL = 0xAC00, HANGUL_COUNT = 11172, L = 0x1100, V = 0x1161, T = 0x11A7, V_COUNT = 21, T_COUNT = 28 };
	if (code >= HANGUL && code < HANGUL + HANGUL_COUNT) {
		const uint32_t n = code - HANGUL;
		code_put(out, L + n / (V_COUNT * T_COUNT));
		code_put(out, V + n / T_COUNT % V_COUNT);
		if (n % T_COUNT)
			code_put(out, T + n % T_COUNT);
		return;
	}
	uint32_t marks[8];
	size_t count = 0;
	for (const struct decomposition *found; count < 8 && (found = decomposition_find(code));) {
		code = found->base;
		if (found->mark)
			marks[count++] = found->mark;
	}
	code_put(out, code);
	while (count)
		code_put(out, marks[--count]);
}

/* The decomposed text, malloc'ed. NULL: it is ASCII, which has one spelling only, or there is no memory. */
static char *normal_form(const char *text)
{
	struct byte_buffer form = {0};
	bool is_ascii = true;
	size_t step;
	for (const uint8_t *at = (const uint8_t *)text; *at; at += step) {
		uint32_t code = 0;
		is_ascii &= *at < 0x80;
		step = name_character(at, 4, &code); /* the NUL ends it sooner */
		if (step)
			code_decompose(&form, code);
		else
			write_u8(&form, *at);
		step += !step;
	}
	write_u8(&form, 0);
	if (is_ascii || form.failed)
		byte_buffer_free(&form);
	return (char *)form.bytes;
}

bool normal_form_equal(const char *a, const char *b)
{
	char *x = strcmp(a, b) != 0 ? normal_form(a) : NULL, *y = x ? normal_form(b) : NULL;
	const bool equal = y && !strcmp(x, y);
	free(x);
	free(y);
	return equal;
}

void normal_forms_add(struct normal_forms *forms, const char *text, size_t number)
{
	char *form = normal_form(text);
	struct normal_form_entry *entry = form ? memory_grown(forms->entry, forms->count, sizeof *entry) : NULL;
	if (!entry) {
		free(form);
		return;
	}
	forms->entry = entry;
	forms->entry[forms->count++] = (struct normal_form_entry){.form = form, .number = number};
	forms->sorted = false;
}

static int entry_compare(const void *a, const void *b)
{
	return strcmp(((const struct normal_form_entry *)a)->form, ((const struct normal_form_entry *)b)->form);
}

bool normal_forms_find(struct normal_forms *forms, const char *text, size_t *number)
{
	char *form = forms->count ? normal_form(text) : NULL;
	if (!form)
		return false;
	if (!forms->sorted)
		qsort(forms->entry, forms->count, sizeof *forms->entry, entry_compare);
	forms->sorted = true;
	const struct normal_form_entry key = {.form = form};
	const struct normal_form_entry *found = bsearch(&key, forms->entry, forms->count, sizeof key, entry_compare);
	if (found)
		*number = found->number;
	free(form);
	return found;
}

void normal_forms_free(struct normal_forms *forms)
{
	for (size_t n = 0; n < forms->count; n++)
		free(forms->entry[n].form);
	free(forms->entry);
	*forms = (struct normal_forms){0};
}
