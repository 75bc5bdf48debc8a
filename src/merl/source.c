#include "source.h"

#include <dirent.h>
#include <errno.h>
#include <search.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "name.h"
#include "error.h"
#include "source_kind.h"

enum { DEPTH_MAX = 1000 };

void source_item_clear(struct source_item *item)
{
	free(item->name);
	free(item->path);
	free(item->member);
	*item = (struct source_item){0};
}

static void notice(struct source_list *list, enum source_notice kind, const char *path, const char *reason)
{
	list->skipped_count += kind == SOURCE_SKIPPED;
	list->damaged_count += kind == SOURCE_DAMAGED;
	if (list->options.notice)
		list->options.notice(list->options.user, kind, path, reason);
}

/* Who has a name: where it was first seen, as a person would write it. */
struct claim {
	char *name, *where;
};

static int claim_compare(const void *a, const void *b)
{
	return strcmp(((const struct claim *)a)->name, ((const struct claim *)b)->name);
}

static void claim_free(void *claim)
{
	free(((struct claim *)claim)->name);
	free(((struct claim *)claim)->where);
	free(claim);
}

/* Checks a material's name and takes it; refuses illegal names and those that are taken. */
static bp_status name_claim(struct source_list *list, const char *name, const char *path, const char *member, bp_error *error)
{
	char where[1024];
	snprintf(where, sizeof where, "%s%s%s", path, member ? ": member " : "", member ? member : "");
	const char *fault = name_fault(name, strlen(name));
	if (fault)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "%s: its stem cannot name a material: %s; rename the file", where, fault);
	struct claim *claim = calloc(1, sizeof *claim);
	if (!claim || !(claim->name = strdup(name)) || !(claim->where = strdup(where))) {
		if (claim)
			claim_free(claim);
		return error_memory(error, sizeof *claim);
	}
	struct claim **holder = tsearch(claim, &list->names, claim_compare);
	if (holder && *holder == claim)
		return BP_OK;
	claim_free(claim);
	if (!holder)
		return error_memory(error, sizeof *claim);
	return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "two materials named %s: %.190s and %.190s; rename or leave out one", name,
	                 (*holder)->where, where);
}

/* A material found at path (and member): its name is checked and claimed unless it is not wanted. */
static bp_status material_take(struct source_list *list, const char *path, const char *member, struct source_item *out, bool *taken,
                               bp_error *error)
{
	char name[SOURCE_STEM_BYTES];
	source_stem(member ? member : path, name);
	*taken = !list->options.wanted || list->options.wanted(list->options.user, name);
	if (!*taken) {
		list->unwanted_count++;
		return BP_OK;
	}
	bp_status status = name_claim(list, name, path, member, error);
	if (status != BP_OK)
		return status;
	struct source_item item = {.name = strdup(name), .path = strdup(path), .member = member ? strdup(member) : NULL};
	if (!item.name || !item.path || (member && !item.member)) {
		source_item_clear(&item);
		return error_memory(error, strlen(path));
	}
	*out = item;
	return BP_OK;
}

/* Room for one more after `count` elements of `size` bytes: capacities are powers of two, so nobody keeps them. NULL: no memory. */
static void *array_room(void *base, size_t count, size_t size)
{
	if (count & (count - 1) || (count && count < 16))
		return base;
	return reallocarray(base, count ? 2 * count : 16, size);
}

static bp_status item_add(struct source_list *list, const char *path, const struct container_member *member, uint64_t bytes,
                          bp_error *error)
{
	bool taken;
	struct source_item *items = array_room(list->items, list->item_count, sizeof *items);
	if (!items)
		return error_memory(error, 2 * list->item_count * sizeof *items);
	list->items = items;
	struct source_item *item = &items[list->item_count];
	bp_status status = material_take(list, path, member ? member->path : NULL, item, &taken, error);
	if (status != BP_OK || !taken)
		return status;
	item->ordinal = member ? member->ordinal : 0;
	item->bytes = member ? member->bytes : bytes;
	list->item_count++;
	return BP_OK;
}

static bp_status stream_add(struct source_list *list, const char *path, bp_error *error)
{
	char **streams = array_room(list->streams, list->stream_count, sizeof *streams);
	if (!streams)
		return error_memory(error, 2 * list->stream_count * sizeof *streams);
	list->streams = streams;
	char *copy = strdup(path);
	if (!copy)
		return error_memory(error, strlen(path));
	streams[list->stream_count++] = copy;
	return BP_OK;
}

/* Lists the members of a container that has an index; anything else becomes a stream. */
static bp_status container_add(struct source_list *list, const char *path, bp_error *error)
{
	struct container *container = NULL;
	struct container_member member;
	bp_error reason = {0};
	bool more = true;
	bp_status status = container_open(path, CONTAINER_INDEXED, &container, &reason);
	if (status == BP_ERROR_UNSUPPORTED)
		return stream_add(list, path, error);
	if (status != BP_OK) {
		notice(list, SOURCE_DAMAGED, path, reason.message);
		return BP_OK;
	}
	while (more) {
		status = container_next(container, &member, &more, &reason);
		if (status == BP_ERROR_MEMORY) {
			status = error_memory(error, 0);
			break;
		}
		if (status != BP_OK) {
			notice(list, SOURCE_DAMAGED, path, reason.message);
			status = BP_OK;
			more = true;
			continue;
		}
		if (more && (status = item_add(list, path, &member, 0, error)) != BP_OK)
			break;
	}
	list->ignored_count += container_ignored(container);
	container_close(container);
	return status;
}

static const char *kind_text(mode_t mode)
{
	switch (mode & S_IFMT) {
	case S_IFIFO: return "a FIFO, not a file";
	case S_IFSOCK: return "a socket, not a file";
	case S_IFCHR:
	case S_IFBLK: return "a device, not a file";
	default: return "neither a file nor a folder";
	}
}

/* Folders of one input that have been entered, so that links cannot lead in a circle. */
struct folder {
	dev_t device;
	ino_t inode;
};
struct visited {
	struct folder *folders;
	size_t count;
};

static bp_status path_add(struct source_list *list, const char *path, bool named, struct visited *visited, int depth, bp_error *error);

static int no_dots(const struct dirent *entry)
{
	return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
}

static int by_bytes(const struct dirent **a, const struct dirent **b)
{
	return strcmp((*a)->d_name, (*b)->d_name);
}

static bp_status folder_add(struct source_list *list, const char *path, const struct stat *about, struct visited *visited, int depth,
                            bp_error *error)
{
	struct dirent **entries = NULL;
	int count = 0;
	bp_status status = BP_OK;
	for (size_t n = 0; n < visited->count; n++)
		if (visited->folders[n].device == about->st_dev && visited->folders[n].inode == about->st_ino) {
			notice(list, SOURCE_SKIPPED, path, "a link to a folder that has been searched already");
			return BP_OK;
		}
	if (depth > DEPTH_MAX) {
		notice(list, SOURCE_SKIPPED, path, "more than 1000 folders deep");
		return BP_OK;
	}
	struct folder *folders = array_room(visited->folders, visited->count, sizeof *folders);
	if (!folders)
		return error_memory(error, 2 * visited->count * sizeof *folders);
	visited->folders = folders;
	folders[visited->count++] = (struct folder){about->st_dev, about->st_ino};
	count = scandir(path, &entries, no_dots, by_bytes);
	if (count < 0) {
		char reason[128];
		snprintf(reason, sizeof reason, "unreadable folder: %s", strerror(errno));
		notice(list, SOURCE_SKIPPED, path, reason);
		return BP_OK;
	}
	for (int n = 0; n < count; n++) {
		char *inner = NULL;
		const char *slash = path[strlen(path) - 1] == '/' ? "" : "/";
		if (status == BP_OK && asprintf(&inner, "%s%s%s", path, slash, entries[n]->d_name) < 0) {
			inner = NULL;
			status = error_memory(error, strlen(path));
		}
		if (status == BP_OK)
			status = path_add(list, inner, false, visited, depth + 1, error);
		free(inner);
		free(entries[n]);
	}
	free(entries);
	return status;
}

/* One file, folder or other thing; `named`: the user gave this very path. */
static bp_status path_add(struct source_list *list, const char *path, bool named, struct visited *visited, int depth, bp_error *error)
{
	struct stat about, link;
	char reason[128];
	if (stat(path, &about) != 0) {
		const int why = errno;
		const bool is_link = lstat(path, &link) == 0 && S_ISLNK(link.st_mode);
		if (named && !is_link)
			return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot open: %s", path, strerror(why));
		snprintf(reason, sizeof reason, "%s: %s", is_link ? "dangling link" : "cannot open", strerror(why));
		notice(list, SOURCE_SKIPPED, path, reason);
		return BP_OK;
	}
	if (S_ISDIR(about.st_mode))
		return folder_add(list, path, &about, visited, depth, error);
	if (!S_ISREG(about.st_mode)) {
		notice(list, SOURCE_SKIPPED, path, kind_text(about.st_mode));
		return BP_OK;
	}
	switch (named ? source_kind_by_content(path) : source_kind_by_name(path)) {
	case SOURCE_KIND_MERL: return item_add(list, path, NULL, (uint64_t)about.st_size, error);
	case SOURCE_KIND_CONTAINER: return container_add(list, path, error);
	case SOURCE_KIND_OTHER: break;
	}
	list->ignored_count++;
	return BP_OK;
}

static int item_compare(const void *a, const void *b)
{
	return strcmp(((const struct source_item *)a)->name, ((const struct source_item *)b)->name);
}

bp_status source_scan(const char *const *inputs, size_t count, const struct source_options *options, struct source_list *out,
                      bp_error *error)
{
	struct source_list list = {0};
	bp_status status = BP_OK;
	if (options)
		list.options = *options;
	for (size_t n = 0; n < count && status == BP_OK; n++) {
		struct visited visited = {0};
		status = path_add(&list, inputs[n], true, &visited, 0, error);
		free(visited.folders);
	}
	if (status != BP_OK) {
		source_list_free(&list);
		return status;
	}
	if (list.item_count)
		qsort(list.items, list.item_count, sizeof *list.items, item_compare);
	*out = list;
	return BP_OK;
}

void source_list_free(struct source_list *list)
{
	for (size_t n = 0; n < list->item_count; n++)
		source_item_clear(&list->items[n]);
	for (size_t n = 0; n < list->stream_count; n++)
		free(list->streams[n]);
	free(list->items);
	free(list->streams);
	tdestroy(list->names, claim_free);
	*list = (struct source_list){0};
}

static int item_name_compare(const void *name, const void *item)
{
	return strcmp(name, ((const struct source_item *)item)->name);
}

const struct source_item *source_list_find(const struct source_list *list, const char *name)
{
	return list->item_count ? bsearch(name, list->items, list->item_count, sizeof *list->items, item_name_compare) : NULL;
}

bp_status source_stream_next(struct source_list *list, const char *path, struct container *stream, struct source_item *out,
                             bool *more, bp_error *error)
{
	struct container_member member;
	for (;;) {
		const size_t ignored = container_ignored(stream);
		bool taken;
		bp_status status = container_next(stream, &member, more, error);
		list->ignored_count += container_ignored(stream) - ignored;
		if (status != BP_OK || !*more)
			return status;
		status = material_take(list, path, member.path, out, &taken, error);
		if (status != BP_OK)
			return status;
		if (taken) {
			out->ordinal = member.ordinal;
			out->bytes = member.bytes;
			return BP_OK;
		}
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
		status = container_open(item->path, CONTAINER_INDEXED, &cursor->container, error);
		if (status != BP_OK)
			return status;
		cursor->path = strdup(item->path);
		if (!cursor->path) {
			source_cursor_close(cursor);
			return error_memory(error, strlen(item->path));
		}
	}
	status = container_seek(cursor->container, item->ordinal, error);
	if (status != BP_OK)
		return status;
	return lattice_read(container_read, cursor->container, reading, out, error);
}
