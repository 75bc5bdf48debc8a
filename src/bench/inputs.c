#include "inputs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tool/whole_file.h"

enum { LIST_BYTES_MAX = 1 << 20 };

static bool is_listed(void *user, const char *name)
{
	const size_t bytes = strlen(name);
	for (const char *line = user; *line; line += strcspn(line, "\n"), line += *line == '\n')
		if (!strncmp(line, name, bytes) && strchr("\t\r\n", line[bytes]))
			return true;
	return false;
}

static void notice_print(void *user, enum source_notice kind, const char *path, const char *reason)
{
	(void)user, (void)kind;
	fprintf(stderr, "brdfpack-bench: %s: %s\n", path, reason);
}

bool inputs_find(char **paths, int count, const char *list, struct source_list *out)
{
	char *names = NULL;
	size_t bytes, inside = 0;
	bp_error error;

	*out = (struct source_list){0};
	if (list && whole_file_read(list, LIST_BYTES_MAX, &names, &bytes, &error)) {
		notice_print(NULL, SOURCE_DAMAGED, list, error.message);
		return false;
	}
	const struct source_options options = {.notice = notice_print, .wanted = list ? is_listed : NULL, .user = names};
	const bp_status status = source_scan((const char *const *)paths, (size_t)count, &options, out, &error);
	free(names);
	if (status) {
		fprintf(stderr, "brdfpack-bench: %s\n", error.message);
		return false;
	}
	for (size_t n = 0; n < out->item_count; n++)
		inside += out->items[n].member != NULL;
	if (inside + out->stream_count == 0 && out->item_count <= MATERIALS_MAX)
		return true;
	fprintf(stderr, "brdfpack-bench: %s\n", inside + out->stream_count ? "a container: unpack it first" : "too many materials");
	source_list_free(out);
	return false;
}

void inputs_thin(struct source_list *inputs, size_t count)
{
	const size_t all = inputs->item_count;

	if (all <= count)
		return;
	inputs->item_count = 0;
	for (size_t n = 0; n < all; n++)
		if (inputs->item_count < count && n == inputs->item_count * (all - 1) / (count > 1 ? count - 1 : 1))
			inputs->items[inputs->item_count++] = inputs->items[n];
		else
			source_item_clear(&inputs->items[n]);
}
