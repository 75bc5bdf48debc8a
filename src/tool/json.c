#include "json.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>

#include "name.h"

static void text_print(FILE *out, const char *string)
{
	const unsigned char *text = (const unsigned char *)string;
	putc('"', out);
	while (*text) {
		uint32_t code;
		size_t length = name_character(text, 4, &code);
		if (!length) {
			fputs("\\ufffd", out);
			length = 1;
		} else if (*text == '"' || *text == '\\') {
			fprintf(out, "\\%c", *text);
		} else if (*text < 0x20 || *text == 0x7f) {
			fprintf(out, "\\u%04x", *text);
		} else {
			fwrite(text, 1, length, out);
		}
		text += length;
	}
	putc('"', out);
}

static void line_indent(struct json *json)
{
	if (!json->indent)
		return;
	putc('\n', json->out);
	for (int i = 0; i < json->depth; i++)
		fputs("  ", json->out);
}

static void member_begin(struct json *json, const char *key)
{
	if (json->depth > 0) {
		if (json->level[json->depth - 1].filled)
			fputs(json->indent ? "," : ", ", json->out);
		json->level[json->depth - 1].filled = true;
		line_indent(json);
	}
	if (key) {
		text_print(json->out, key);
		fputs(": ", json->out);
	}
}

static void level_open(struct json *json, const char *key, char open, char close)
{
	assert(json->depth < JSON_DEPTH_MAX);
	member_begin(json, key);
	putc(open, json->out);
	json->level[json->depth].close = close;
	json->level[json->depth++].filled = false;
}

struct json json_begin(FILE *out, bool indent)
{
	struct json json = {.out = out, .indent = indent};
	level_open(&json, NULL, '{', '}');
	return json;
}

void json_object(struct json *json, const char *key) { level_open(json, key, '{', '}'); }

void json_array(struct json *json, const char *key) { level_open(json, key, '[', ']'); }

void json_close(struct json *json)
{
	assert(json->depth > 0);
	json->depth--;
	if (json->level[json->depth].filled)
		line_indent(json);
	putc(json->level[json->depth].close, json->out);
}

void json_finish(struct json *json)
{
	json_close(json);
	assert(json->depth == 0);
	putc('\n', json->out);
}

void json_string(struct json *json, const char *key, const char *text)
{
	member_begin(json, key);
	text_print(json->out, text);
}

void json_integer(struct json *json, const char *key, uint64_t value)
{
	member_begin(json, key);
	fprintf(json->out, "%" PRIu64, value);
}

void json_number(struct json *json, const char *key, double value)
{
	member_begin(json, key);
	if (isfinite(value))
		fprintf(json->out, "%.17g", value);
	else
		fputs("null", json->out);
}

void json_bool(struct json *json, const char *key, bool value)
{
	member_begin(json, key);
	fputs(value ? "true" : "false", json->out);
}

void json_hex(struct json *json, const char *key, const uint8_t *bytes, size_t count)
{
	member_begin(json, key);
	putc('"', json->out);
	for (size_t i = 0; i < count; i++)
		fprintf(json->out, "%02x", bytes[i]);
	putc('"', json->out);
}
