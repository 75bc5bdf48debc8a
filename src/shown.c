#include "shown.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "name.h"

struct range {
	uint32_t first, last;
};

static bool in_ranges(uint32_t code, const struct range *ranges, size_t count)
{
	for (size_t i = 0; i < count; i++)
		if (code >= ranges[i].first && code <= ranges[i].last)
			return true;
	return false;
}
#define IN(code, ranges) in_ranges(code, ranges, sizeof ranges / sizeof *ranges)

/* Controls; soft hyphen; Arabic letter mark; zero-width, bidirectional marks; separators; hidden operators; tags. */
static const struct range UNSEEN[] = {{0x00, 0x1F},     {0x7F, 0x9F},     {0xAD, 0xAD},       {0x61C, 0x61C},
                                      {0x180E, 0x180E}, {0x200B, 0x200F}, {0x2028, 0x202E},   {0x2060, 0x206F},
                                      {0xFEFF, 0xFEFF}, {0xFFF9, 0xFFFB}, {0x1D173, 0x1D17A}, {0xE0000, 0xE007F}};
/* Marks that are drawn over the character before them. */
static const struct range COMBINING[] = {
	{0x300, 0x36F},   {0x483, 0x489},   {0x591, 0x5BD},   {0x610, 0x61A},   {0x64B, 0x65F},    {0x93C, 0x93C},
	{0x94D, 0x94D},   {0xE31, 0xE31},   {0xE34, 0xE3A},   {0xE47, 0xE4E},   {0x1AB0, 0x1AFF},  {0x1DC0, 0x1DFF},
	{0x20D0, 0x20FF}, {0x3099, 0x309A}, {0xFE00, 0xFE0F}, {0xFE20, 0xFE2F}, {0xE0100, 0xE01EF}};
/* Unicode's East Asian Width W and F, in large ranges. */
static const struct range WIDE[] = {{0x1100, 0x115F},   {0x2E80, 0x303E},   {0x3041, 0x33FF},   {0x3400, 0x4DBF},
                                    {0x4E00, 0x9FFF},   {0xA000, 0xA4CF},   {0xA960, 0xA97F},   {0xAC00, 0xD7A3},
                                    {0xF900, 0xFAFF},   {0xFE30, 0xFE6F},   {0xFF01, 0xFF60},   {0xFFE0, 0xFFE6},
                                    {0x1F300, 0x1F64F}, {0x1F680, 0x1F6FF}, {0x1F900, 0x1F9FF}, {0x20000, 0x3FFFD}};

size_t shown_next(const char **from, char out[SHOWN_STEP_MAX], int *columns)
{
	static const char digits[] = "0123456789abcdef";
	const uint8_t *s = (const uint8_t *)*from;
	uint32_t code = 0;

	if (!*s)
		return 0;
	const size_t length = name_character(s, SHOWN_STEP_MAX, &code); /* the NUL ends it sooner */
	const bool plain = length > 0 && !IN(code, UNSEEN);
	const size_t taken = length > 0 ? length : 1;
	*from += taken;
	if (plain) {
		memcpy(out, s, length);
		if (columns)
			*columns = IN(code, COMBINING) ? 0 : IN(code, WIDE) ? 2 : 1;
		return length;
	}
	for (size_t i = 0; i < taken; i++) {
		out[4 * i] = '\\';
		out[4 * i + 1] = 'x';
		out[4 * i + 2] = digits[s[i] >> 4];
		out[4 * i + 3] = digits[s[i] & 15];
	}
	if (columns)
		*columns = (int)(4 * taken);
	return 4 * taken;
}

size_t shown_text(char *to, size_t room, const char *from)
{
	char step[SHOWN_STEP_MAX];
	size_t used = 0;
	for (size_t n; (n = shown_next(&from, step, NULL)) > 0 && used + n < room; used += n)
		memcpy(to + used, step, n);
	to[used] = '\0';
	return used;
}

int shown_columns(const char *text)
{
	char step[SHOWN_STEP_MAX];
	int columns = 0, one;
	while (shown_next(&text, step, &one))
		columns += one;
	return columns;
}
