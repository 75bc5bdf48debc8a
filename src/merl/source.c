#include "source.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "error.h"
#include "memory.h"
#include "name.h"
#include "output_path.h"
#include "source_names.h"

enum { DEPTH_MAX = 1000 };

static void notice(struct source_list *list, enum source_notice kind, const char *path, const char *reason)
{
	list->skipped_count += kind == SOURCE_SKIPPED;
	list->damaged_count += kind == SOURCE_DAMAGED;
	if (list->options.notice)
		list->options.notice(list->options.user, kind, path, reason);
}

/* Tells of a material that cannot be packed. */
static bp_status refuse(struct source_list *list, const char *name, const char *path, const char *member, const char *reason,
                        bp_error *error)
{
	struct source_item item;
	char *where = NULL;
	bp_status status = source_item_fill(&item, name, path, member, true, error);
	if (!status && asprintf(&where, "%s%s%s", path, member ? ": " : "", member ? item.member : "") < 0) {
		where = NULL;
		status = error_memory(error, strlen(path));
	}
	if (!status && list->options.refused)
		list->options.refused(list->options.user, &item, reason);
	else if (!status && list->options.notice)
		list->options.notice(list->options.user, SOURCE_DAMAGED, where, reason);
	list->refused_count++;
	free(where);
	source_item_clear(&item);
	return status;
}

static bp_status item_add(struct source_list *list, const char *path, const struct container_member *member, uint64_t bytes,
                          bp_error *error)
{
	char name[SOURCE_STEM_BYTES];
	bp_error why;
	const char *const inner = member ? member->path : NULL;
	const bp_status fault = source_name_make(path, inner, member ? member->fault : NULL, name, &why);
	if (!source_is_wanted(list, name)) {
		list->unwanted_count++;
		return BP_OK;
	}
	if (fault)
		return refuse(list, name, path, inner, why.message, error);
	struct source_item *items = memory_grown(list->items, list->item_count, sizeof *items);
	if (!items)
		return error_memory(error, 2 * list->item_count * sizeof *items);
	list->items = items;
	struct source_item *item = &items[list->item_count];
	const bp_status status = source_item_fill(item, name, path, inner, false, error);
	if (status)
		return status;
	item->ordinal = member ? member->ordinal : 0;
	item->bytes = member ? member->bytes : bytes;
	list->item_count++;
	return BP_OK;
}

static bp_status stream_add(struct source_list *list, const char *path, bool named, bp_error *error)
{
	/* in the order of their paths, and each once, so that the order of the inputs decides nothing */
	size_t at = list->stream_count;
	while (at > 0 && strcmp(list->streams[at - 1].path, path) > 0)
		at--;
	if (at > 0 && !strcmp(list->streams[at - 1].path, path)) {
		list->streams[at - 1].named |= named;
		return BP_OK;
	}
	struct source_stream *streams = memory_grown(list->streams, list->stream_count, sizeof *streams);
	if (streams)
		list->streams = streams;
	char *copy = streams ? strdup(path) : NULL;
	if (!copy)
		return error_memory(error, strlen(path));
	memmove(streams + at + 1, streams + at, (list->stream_count - at) * sizeof *streams);
	streams[at] = (struct source_stream){.path = copy, .named = named};
	list->stream_count++;
	return BP_OK;
}

/* Lists the members of a container that has an index; anything else becomes a stream. */
static bp_status container_add(struct source_list *list, const char *path, bool named, bp_error *error)
{
	struct container *container = NULL;
	struct container_member member;
	bp_error reason = {0};
	bool more = true;
	bp_status status = container_open(path, CONTAINER_INDEXED, list->options.charset, &container, &reason);
	if (status == BP_ERROR_UNSUPPORTED)
		return stream_add(list, path, named, error);
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
	const struct container_sums *sums = container_sums(container);
	if (sums->remark && status == BP_OK)
		notice(list, SOURCE_DAMAGED, path, sums->remark);
	list->ignored_count += sums->ignored;
	source_licences_take(list, path, container);
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

static bp_status path_add(struct source_list *list, const char *path, bool named, struct visited *visited, int depth,
                          bp_error *error);

static int no_dots(const struct dirent *entry) { return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0; }

static int by_bytes(const struct dirent **a, const struct dirent **b) { return strcmp((*a)->d_name, (*b)->d_name); }

static bp_status folder_add(struct source_list *list, const char *path, const struct stat *about, struct visited *visited,
                            int depth, bp_error *error)
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
		notice(list, SOURCE_DAMAGED, path, "more than 1000 folders deep: what is below is not searched");
		return BP_OK;
	}
	struct folder *folders = memory_grown(visited->folders, visited->count, sizeof *folders);
	if (!folders)
		return error_memory(error, 2 * visited->count * sizeof *folders);
	visited->folders = folders;
	folders[visited->count++] = (struct folder){about->st_dev, about->st_ino};
	count = scandir(path, &entries, no_dots, by_bytes);
	if (count < 0) {
		char reason[128];
		snprintf(reason, sizeof reason, "unreadable folder: %s", strerror(errno));
		notice(list, SOURCE_DAMAGED, path, reason);
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

/* What is no file: an input when it is named, or is called like one; otherwise one more of the other files. */
static bp_status thing_add(struct source_list *list, const char *path, bool named, const char *reason, bp_error *error)
{
	const enum source_kind kind = source_kind_by_name(path);
	char name[SOURCE_STEM_BYTES];
	if (!named && kind == SOURCE_KIND_OTHER) {
		list->ignored_count++;
		return BP_OK;
	}
	if (kind != SOURCE_KIND_MEASURED) {
		notice(list, SOURCE_DAMAGED, path, reason);
		return BP_OK;
	}
	source_stem(path, name);
	if (source_is_wanted(list, name))
		return refuse(list, name, path, NULL, reason, error);
	list->unwanted_count++;
	return BP_OK;
}

/* One file, folder or other thing; `named`: the user gave this very path. */
static bp_status path_add(struct source_list *list, const char *path, bool named, struct visited *visited, int depth,
                          bp_error *error)
{
	struct stat about, link;
	char reason[128];
	if (stat(path, &about) != 0) {
		const int why = errno;
		const bool is_link = lstat(path, &link) == 0 && S_ISLNK(link.st_mode);
		if (named && !is_link)
			return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot open: %s", path, strerror(why));
		snprintf(reason, sizeof reason, "%s: %s", is_link ? "dangling link" : "cannot open", strerror(why));
		return thing_add(list, path, named, reason, error);
	}
	if (S_ISDIR(about.st_mode))
		return folder_add(list, path, &about, visited, depth, error);
	if (!S_ISREG(about.st_mode))
		return thing_add(list, path, named, kind_text(about.st_mode), error);
	enum source_kind kind = named ? source_kind_by_content(path) : source_kind_by_name(path);
	if (kind == SOURCE_KIND_OTHER && name_in_path(path)[0] != '.' && source_is_tensor_file(path))
		kind = SOURCE_KIND_MEASURED;
	switch (kind) {
	case SOURCE_KIND_MEASURED: return item_add(list, path, NULL, (uint64_t)about.st_size, error);
	case SOURCE_KIND_CONTAINER: return container_add(list, path, named, error);
	case SOURCE_KIND_FOREIGN:
		notice(list, SOURCE_DAMAGED, path,
		       "a container of a kind that is not read, or a part of one; unpack it, or pack it as zip or tar");
		return BP_OK;
	case SOURCE_KIND_OTHER:
		if ((uint64_t)about.st_size == merl_file_bytes(LATTICE_MERL))
			notice(list, SOURCE_SKIPPED, path,
			       "as large as a MERL file, but not called NAME.binary; rename it, or name it on the command line");
		break;
	}
	if (output_path_unfinished(path))
		return BP_OK;
	list->ignored_count++;
	licences_note(&list->licences, path, NULL);
	return BP_OK;
}

/* By name; those of one name by path and place, so that the same one comes first whatever the order of the inputs. */
static int item_compare(const void *a, const void *b)
{
	const struct source_item *x = a, *y = b;
	int order = strcmp(x->name, y->name);
	if (order == 0)
		order = strcmp(x->path, y->path);
	return order ? order : (x->ordinal > y->ordinal) - (x->ordinal < y->ordinal);
}

/* Sorts the items. The same file met twice is one. */
static void items_sort(struct source_list *list)
{
	size_t kept = 0;
	if (list->item_count)
		qsort(list->items, list->item_count, sizeof *list->items, item_compare);
	for (size_t n = 0; n < list->item_count; n++)
		if (kept > 0 && item_compare(&list->items[kept - 1], &list->items[n]) == 0)
			source_item_clear(&list->items[n]);
		else
			list->items[kept++] = list->items[n];
	list->item_count = kept;
}

/* Keeps the first of each name. */
static bp_status items_claim(struct source_list *list, bp_error *error)
{
	const size_t count = list->item_count;
	bp_status status = BP_OK;
	list->item_count = 0;
	for (size_t n = 0; n < count; n++) {
		struct source_item item = list->items[n];
		bp_error why;
		const bp_status claimed = status ? status : source_name_claim(&list->names, item.name, item.path, item.member, &why);
		if (claimed == BP_OK) {
			list->items[list->item_count++] = item;
			continue;
		}
		if (!status)
			status = claimed == BP_ERROR_ARGUMENT ? refuse(list, item.name, item.path, item.member, why.message, error)
			                                      : error_memory(error, sizeof item);
		source_item_clear(&item);
	}
	return status;
}

/* Tells of an input that gave nothing, where nothing else was told. */
static void input_check(struct source_list *list, const char *path, const struct source_list *before)
{
	char reason[160];
	if (list->item_count > before->item_count || list->stream_count > before->stream_count ||
	    list->unwanted_count > before->unwanted_count || list->refused_count > before->refused_count ||
	    list->damaged_count > before->damaged_count || list->skipped_count > before->skipped_count)
		return;
	snprintf(reason, sizeof reason, SOURCE_EMPTY, list->ignored_count - before->ignored_count);
	notice(list, SOURCE_DAMAGED, path, reason);
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
		const struct source_list before = list;
		status = path_add(&list, inputs[n], true, &visited, 0, error);
		if (status == BP_OK)
			input_check(&list, inputs[n], &before);
		free(visited.folders);
	}
	if (status == BP_OK)
		items_sort(&list);
	if (status == BP_OK)
		status = items_claim(&list, error);
	if (status != BP_OK) {
		source_list_free(&list);
		return status;
	}
	*out = list;
	return BP_OK;
}

void source_list_free(struct source_list *list)
{
	for (size_t n = 0; n < list->item_count; n++)
		source_item_clear(&list->items[n]);
	for (size_t n = 0; n < list->stream_count; n++)
		free(list->streams[n].path);
	free(list->items);
	free(list->streams);
	licences_free(&list->licences);
	source_names_free(list->names);
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
