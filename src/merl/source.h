/*
 * source.h: what `build` is given -> materials: MERL files, those of the RGL database, folders searched to the bottom,
 * tars and zips. Part of the tool, not of the library.
 *
 * What counts. A file given by name is a measured file (MERL's, or one of the RGL database) or a container by its content,
 * whatever it is called. In a folder, *.binary and *.bsdf are measured files, as is what begins like one of the RGL database, and
 * *.zip, *.tar, *.tar.gz (.bz2 .xz .lzma .zst .Z), *.tgz, *.tbz, *.tbz2, *.txz, *.tzst, and *.binary.gz and so on are containers;
 * other and hidden files (".x") are passed over and counted. A material's name is the file's stem: the last part
 * of its path without the suffix. Links to files and folders are followed; a folder is searched once.
 *
 * Two kinds of materials. An *item* can be read by any worker on its own: a file, or a member of a
 * container in which passing over others is cheap. A *stream* is a container that has to be read
 * from beginning to end (a compressed tar): its members turn up while it is read, one after another.
 *
 *     source_scan -> items (sorted by name), streams
 *     source_item_read: item -> lattice          container_open, source_stream_next, container_read
 */
#ifndef MERL_SOURCE_H
#define MERL_SOURCE_H

#include "container.h"

enum source_notice {
	SOURCE_SKIPPED, /* nothing is lost by it, as a folder that is met twice: a warning */
	SOURCE_DAMAGED  /* a container or a folder that cannot be read (further), or has no material: counts as a failed input */
};

struct source_item;

struct source_options {
	/* Told what is left out, and why; may be NULL. `reason` is one line without the path. */
	void (*notice)(void *user, enum source_notice kind, const char *path, const char *reason);
	/* Told of a single material that cannot be packed, and why. Its name and member are fit to be shown: what is no legal text is
	 * escaped. NULL: notice is told, as SOURCE_DAMAGED, of "PATH: MEMBER". */
	void (*refused)(void *user, const struct source_item *item, const char *reason);
	/* Whether a material of that name is asked for (a manifest); NULL: all are. */
	bool (*wanted)(void *user, const char *name);
	void *user;
	const char *charset; /* of names in containers that are not UTF-8 (container.h); NULL: unknown */
};

struct source_item {
	char *name;
	char *path;       /* the file, or the container */
	char *member;     /* path inside the container, or NULL for a plain file */
	uint32_t ordinal; /* of the member in its container */
	uint64_t bytes;   /* of the measured file; UINT64_MAX where unknown */
};

struct source_list {
	struct source_item *items; /* in ascending byte order of names */
	size_t item_count;
	struct source_stream {
		char *path;
		bool named; /* the user gave this very path */
	} * streams;    /* in ascending byte order of paths */
	size_t stream_count;
	size_t ignored_count;                /* files that are neither measured files nor containers by their name */
	struct licences licences;            /* of these, texts of licences */
	size_t unwanted_count;               /* materials that options->wanted turned down */
	size_t skipped_count, damaged_count; /* notices of each kind */
	size_t refused_count;                /* materials that cannot be packed */
	struct source_options options;
	void *names;      /* who has which name */
	const void *told; /* the container of a stream, whose emptiness or fault was told */
};

/*
 * Lists what the inputs hold; reads no table. Every material that is wanted is listed or refused: refused are illegal names, what
 * has no bytes of its own, and of materials of one name all but the first in the order of paths and members, whatever the order
 * of the inputs. An input that is not there ends it (BP_ERROR_IO; nothing to free then), one without any material is told. An
 * empty result is no error here. Free with source_list_free.
 */
bp_status source_scan(const char *const *inputs, size_t count, const struct source_options *options, struct source_list *out,
                      bp_error *error);
void source_list_free(struct source_list *list);

/* The item of that name, or NULL. */
const struct source_item *source_list_find(const struct source_list *list, const char *name);

/*
 * The next wanted material of stream `number`, which the caller opened (CONTAINER_SEQUENTIAL): *out belongs
 * to the caller (source_item_clear); read it with container_read. *more = false at the end.
 * Errors concern one member, as in container_next. Where that is a material which is refused, *out says which, as for
 * options->refused, and belongs to the caller too; otherwise out->name is NULL, and messages name the member.
 */
bp_status source_stream_next(struct source_list *list, size_t number, struct container *stream, struct source_item *out,
                             bool *more, bp_error *error);
/*
 * An item's strings: copies are made, of name and member as people are shown them where the item is refused (BP_ERROR_MEMORY:
 * none), and freed. member may be NULL.
 */
bp_status source_item_fill(struct source_item *item, const char *name, const char *path, const char *member, bool refused,
                           bp_error *error);
void source_item_clear(struct source_item *item);

/* What is told of an input without any material: what was passed over in it. */
#define SOURCE_EMPTY "no material in it; other files passed over: %zu (measured ones end in .binary or .bsdf)"

/* Notes the texts of licences that were met in a container so far. */
void source_licences_take(struct source_list *list, const char *path, const struct container *container);

/* What options->wanted says. */
bool source_is_wanted(const struct source_list *list, const char *name);

/*
 * Reads one item. The cursor keeps a container open between calls: start with {0}, and
 * source_cursor_close it in the end. Each worker has its own; members in ascending order of their
 * container are quickest. Messages do not repeat item->path.
 */
struct source_cursor {
	struct container *container;
	char *path;
};
bp_status source_item_read(const struct source_item *item, struct source_cursor *cursor, const struct merl_reading *reading,
                           struct lattice *out, bp_error *error);
void source_cursor_close(struct source_cursor *cursor);

#endif
