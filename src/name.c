#include "name.h"

#include "bytes.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

size_t name_character(const uint8_t *s, size_t left, uint32_t *code)
{
	size_t length = s[0] < 0x80 ? 1 : s[0] < 0xC2 ? 0 : s[0] < 0xE0 ? 2 : s[0] < 0xF0 ? 3 : s[0] < 0xF5 ? 4 : 0;
	if (!length || length > left)
		return 0;
	uint32_t value = length == 1 ? s[0] : s[0] & (0xFFu >> (length + 1));
	for (size_t i = 1; i < length; i++) {
		if ((s[i] & 0xC0) != 0x80)
			return 0;
		value = value << 6 | (s[i] & 0x3F);
	}
	if ((length == 3 && value < 0x800) || (length == 4 && value < 0x10000) || value > 0x10FFFF ||
	    (value >= 0xD800 && value <= 0xDFFF))
		return 0;
	*code = value;
	return length;
}

const char *name_fault(const char *name, size_t count)
{
	const uint8_t *bytes = (const uint8_t *)name;
	if (count == 0)
		return "it is empty";
	if (count > 255)
		return "it is longer than 255 bytes";
	if (bytes[0] == '.' && (count == 1 || (count == 2 && bytes[1] == '.')))
		return "\".\" and \"..\" are not names";
	for (size_t at = 0, step; at < count; at += step) {
		uint32_t code;
		step = name_character(bytes + at, count - at, &code);
		if (!step)
			return "it is not UTF-8";
		if (code < 0x20 || (code >= 0x7F && code < 0xA0))
			return "it holds a control character";
		if (code == '/')
			return "it holds a '/'";
	}
	return NULL;
}

const char *name_in_path(const char *path)
{
	const char *slash = strrchr(path, '/');
	return slash ? slash + 1 : path;
}

bool name_text(const char *name)
{
	uint32_t code;
	for (size_t left = strlen(name), step; left > 0; name += step, left -= step)
		if (!(step = name_character((const uint8_t *)name, left, &code)))
			return false;
	return true;
}

uint32_t name_shard(const char *name, uint32_t count) { return bytes_crc32((const uint8_t *)name, strlen(name)) % count + 1; }

int name_compare(const char *a, size_t a_bytes, const char *b, size_t b_bytes)
{
	int order = memcmp(a, b, a_bytes < b_bytes ? a_bytes : b_bytes);
	if (order == 0)
		order = (a_bytes > b_bytes) - (a_bytes < b_bytes);
	return (order > 0) - (order < 0);
}
