/*
 * json.h: a small JSON writer. It keeps the commas; the caller keeps begin and end in pairs.
 *
 * The output is valid for every input: strings are escaped, bytes that are not UTF-8 become
 * U+FFFD, numbers that are not finite become null. Finite numbers are printed with 17
 * significant digits, so they read back as the same double.
 */
#ifndef TOOL_JSON_H
#define TOOL_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { JSON_DEPTH_MAX = 16 };

struct json {
	FILE *out;
	bool indent; /* one member per line, for people; otherwise everything on one line */
	int depth;
	struct {
		char close;  /* '}' or ']' */
		bool filled; /* a comma is due before the next member */
	} level[JSON_DEPTH_MAX];
};

/* An object, whose members follow. */
struct json json_begin(FILE *out, bool indent);
void json_finish(struct json *json); /* closes it, and ends the line; what was opened within is closed by then */

/* `key` is NULL for members of arrays. */
void json_object(struct json *json, const char *key);
void json_array(struct json *json, const char *key);
void json_close(struct json *json); /* the innermost object or array */

void json_string(struct json *json, const char *key, const char *text);
void json_integer(struct json *json, const char *key, uint64_t value);
void json_number(struct json *json, const char *key, double value);
void json_bool(struct json *json, const char *key, bool value);
void json_hex(struct json *json, const char *key, const uint8_t *bytes, size_t count);

#endif
