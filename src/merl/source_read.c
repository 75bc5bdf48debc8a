/* source_read.c: one material after the other, of what source.c listed. */
#include "source.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "source_names.h"

void source_item_clear(struct source_item *item)
{
	free(item->name);
	free(item->path);
	free(item->member);
	*item = (struct source_item){0};
}

bp_status source_item_fill(struct source_item *item, const char *name, const char *path, const char *member, bool refused,
                           bp_error *error)
{
	char *(*const copy)(const char *) = refused ? source_text_shown : strdup;
	*item = (struct source_item){.name = copy(name), .path = strdup(path), .member = member ? copy(member) : NULL};
	if (item->name && item->path && (!member || item->member))
		return BP_OK;
	source_item_clear(item);
	return error_memory(error, strlen(path));
}

void source_licences_take(struct source_list *list, const char *path, const struct container *container)
{
	const struct licences *found = &container_sums(container)->licences;
	for (size_t n = 0; n < found->count; n++)
		licences_note(&list->licences, path, found->path[n]);
}

bool source_is_wanted(const struct source_list *list, const char *name)
{
	return !list->options.wanted || list->options.wanted(list->options.user, name);
}

/* A member that is wanted: taken, or refused with *out filled all the same. */
static bp_status member_take(struct source_list *list, const char *path, const struct container_member *member, const char *name,
                             bp_status fault, struct source_item *out, bp_error *error)
{
	const bp_status status = fault ? fault : source_name_claim(&list->names, name, path, member->path, error);
	if (source_item_fill(out, name, path, member->path, status != BP_OK, error))
		return BP_ERROR_MEMORY;
	out->ordinal = member->ordinal;
	out->bytes = member->bytes;
	list->refused_count += status != BP_OK;
	return status;
}

bp_status source_stream_next(struct source_list *list, size_t number, struct container *stream, struct source_item *out,
                             bool *more, bp_error *error)
{
	const struct container_sums *sums = container_sums(stream);
	const char *path = list->streams[number].path;
	struct container_member member;
	char name[SOURCE_STEM_BYTES];
	*out = (struct source_item){0};
	for (;;) {
		const size_t ignored = sums->ignored;
		bp_status status = container_next(stream, &member, more, error);
		list->ignored_count += sums->ignored - ignored;
		if (status != BP_OK)
			return status;
		if (!*more) {
			source_licences_take(list, path, stream);
			const bool tell = list->told != stream && (sums->remark || (sums->members == 0 && list->streams[number].named));
			list->told = tell ? stream : NULL;
			if (!tell)
				return BP_OK;
			return sums->remark ? error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s", sums->remark)
			                    : error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, SOURCE_EMPTY, sums->ignored);
		}
		const bp_status fault = source_name_make(path, member.path, member.fault, name, error);
		if (source_is_wanted(list, name))
			return member_take(list, path, &member, name, fault, out, error);
		list->unwanted_count++;
	}
}

void source_cursor_close(struct source_cursor *cursor)
{
	container_close(cursor->container);
	free(cursor->path);
	*cursor = (struct source_cursor){0};
}

bp_status source_item_read(const struct source_item *item, struct source_cursor *cursor, const struct merl_reading *reading,
                           struct lattice *out, bp_error *error)
{
	bp_status status;
	if (!item->member)
		return lattice_read_path(item->path, reading, out, error);
	if (!cursor->container || strcmp(cursor->path, item->path) != 0 || !container_ahead(cursor->container, item->ordinal)) {
		source_cursor_close(cursor);
		status = container_open(item->path, CONTAINER_INDEXED, NULL, &cursor->container, error);
		if (status != BP_OK)
			return status;
		cursor->path = strdup(item->path);
		if (!cursor->path) {
			source_cursor_close(cursor);
			return error_memory(error, strlen(item->path));
		}
	}
	status = container_seek(cursor->container, item->ordinal, error);
	return status ? status : lattice_read(container_read, cursor->container, reading, out, error);
}
