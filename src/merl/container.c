#include "container.h"

#include <archive.h>
#include <archive_entry.h>
#include <errno.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "container_fault.h"
#include "error.h"
#include "input.h"
#include "name.h"
#include "source_kind.h"

enum { BLOCK_BYTES = 1 << 18, FAILURES_MAX = 1000 };

struct container {
	struct archive *archive;
	struct archive_entry *entry; /* the current one; libarchive's */
	int fd;
	char *raw_name; /* of the only member of a compressed file that is no archive; else NULL */
	char *path;     /* of the current member, or NULL */
	uint32_t next;  /* ordinal of the next entry */
	bool current;   /* an entry has been reached, and none of its bytes read */
	bool pending;   /* the first entry, read while opening */
	bool finished;
	unsigned failures; /* entries that could not be read; a limit keeps hostile files from going on for ever */
	struct container_sums sums;
	char fault[512]; /* of the current member */
	locale_t locale;
};

/* libarchive converts names to the thread's character set: without UTF-8 it would lose them in a C locale. */
static locale_t locale_enter(const struct container *container)
{
	return container->locale ? uselocale(container->locale) : (locale_t)0;
}

static void locale_leave(locale_t before)
{
	if (before)
		uselocale(before);
}

static const char *reason_of(struct archive *archive)
{
	const char *text = archive_error_string(archive);
	return text && *text ? text : "unknown format or damaged";
}

static bp_status refuse(struct container *container, const char *what, bp_error *error)
{
	struct archive *archive = container->archive;
	if (archive_errno(archive) == ENOMEM)
		return error_set(error, BP_ERROR_MEMORY, BP_NO_OFFSET, "out of memory");
	if (container->path)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "member %s: %s: %s", container->path, what, reason_of(archive));
	return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s: %s", what, reason_of(archive));
}

/* x.binary.gz -> x.binary: what a compressed file that is no archive holds. */
static char *raw_member_name(const char *path)
{
	const char *base = name_in_path(path), *dot = strrchr(base, '.');
	return dot && dot != base ? strndup(base, (size_t)(dot - base)) : strdup(base);
}

/* A format that knows no such option answers ARCHIVE_WARN or ARCHIVE_FAILED; the others take it. */
static void options_set(struct archive *archive, const char *charset)
{
	archive_read_set_format_option(archive, "tar", "read_concatenated_archives", "1");
	if (charset) {
		archive_read_set_format_option(archive, "tar", "hdrcharset", charset);
		archive_read_set_format_option(archive, "zip", "hdrcharset", charset);
	}
}

static bool formats_choose(struct archive *archive, enum container_order order)
{
	if (archive_read_support_format_tar(archive) != ARCHIVE_OK)
		return false;
	if (order == CONTAINER_INDEXED)
		return archive_read_support_format_zip_seekable(archive) == ARCHIVE_OK;
	/* A filter that needs an outside program answers ARCHIVE_WARN; it is not wanted, and not asked for. */
	archive_read_support_filter_gzip(archive);
	archive_read_support_filter_bzip2(archive);
	archive_read_support_filter_xz(archive);
	archive_read_support_filter_lzma(archive);
	archive_read_support_filter_zstd(archive);
	archive_read_support_filter_compress(archive);
	return archive_read_support_format_zip(archive) == ARCHIVE_OK && archive_read_support_format_raw(archive) == ARCHIVE_OK;
}

static int format_of(const struct container *container) { return archive_format(container->archive) & ARCHIVE_FORMAT_BASE_MASK; }

/* libarchive's answer. */
static int header_next(struct container *container)
{
	int answer;
	do
		answer = archive_read_next_header(container->archive, &container->entry);
	while (answer == ARCHIVE_RETRY);
	return answer;
}

/* At the end of a tar, or of a compressed file: does the file end too? A zip's directory is there: container_fault sees it. */
static void end_look(struct container *container)
{
	const int format = format_of(container);
	const la_int64_t read = archive_filter_bytes(container->archive, -1);
	if (!container->sums.remark && (format == ARCHIVE_FORMAT_TAR || format == ARCHIVE_FORMAT_RAW) && read >= 0)
		container->sums.remark = container_rest(container->fd, read);
}

/* The next entry of any kind; *more = false at the end. After an error the next call goes on, unless it was fatal. */
static bp_status entry_next(struct container *container, bool *more, bp_error *error)
{
	*more = false;
	container->current = false;
	free(container->path);
	container->path = NULL;
	if (container->finished)
		return BP_OK;
	const int answer = container->pending ? ARCHIVE_OK : header_next(container);
	container->pending = false;
	container->failures += answer == ARCHIVE_FAILED;
	if (answer == ARCHIVE_EOF || answer == ARCHIVE_FATAL || container->failures > FAILURES_MAX)
		container->finished = true;
	if (answer == ARCHIVE_EOF) {
		end_look(container);
		return BP_OK;
	}
	if (answer != ARCHIVE_OK && answer != ARCHIVE_WARN) {
		container->next += answer != ARCHIVE_FATAL;
		return refuse(container, "damaged", error);
	}
	container->next++;
	container->current = *more = true;
	const char *stored = archive_entry_pathname_utf8(container->entry);
	if (!stored)
		stored = archive_entry_pathname(container->entry); /* a tar's bytes that are not UTF-8 */
	container->path = strdup(container->raw_name ? container->raw_name : stored ? stored : "");
	return container->path ? BP_OK : error_memory(error, 256);
}

bp_status container_open(const char *path, enum container_order order, const char *charset, struct container **out,
                         bp_error *error)
{
	uint64_t file_bytes;
	struct container *container = calloc(1, sizeof *container);
	if (!container)
		return error_memory(error, sizeof *container);
	container->locale = newlocale(LC_CTYPE_MASK, "C.UTF-8", (locale_t)0);
	container->archive = archive_read_new();
	bp_status status = input_open(path, &container->fd, &file_bytes, error);
	if (!status && (!container->archive || !formats_choose(container->archive, order)))
		status = error_memory(error, BLOCK_BYTES);
	if (status)
		goto out;
	const locale_t before = locale_enter(container);
	options_set(container->archive, charset);
	int answer = archive_read_open_fd(container->archive, container->fd, BLOCK_BYTES);
	if (answer == ARCHIVE_OK)
		answer = header_next(container);
	const bool raw = format_of(container) == ARCHIVE_FORMAT_RAW;
	const int filters = archive_filter_count(container->archive); /* one of them is the file itself */
	container->pending = answer == ARCHIVE_OK || answer == ARCHIVE_WARN;
	container->finished = answer == ARCHIVE_EOF;
	if (!container->pending && !container->finished)
		status = refuse(container, "not readable as tar or zip", error);
	locale_leave(before);
	/* Any bytes at all pass for "raw" and for an empty tar: only a compressed file may be the one, and zeros the other. */
	if (status != BP_OK && order == CONTAINER_INDEXED)
		status = error_set(error, BP_ERROR_UNSUPPORTED, BP_NO_OFFSET, "neither a plain tar nor a zip with a directory");
	else if (status == BP_OK && raw && filters < 2)
		status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "neither tar nor zip");
	if (status != BP_OK && status != BP_ERROR_UNSUPPORTED && status != BP_ERROR_MEMORY && container_fault(container->fd))
		status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s", container_fault(container->fd));
	else if (status == BP_OK && (container->finished || format_of(container) == ARCHIVE_FORMAT_ZIP))
		container->sums.remark = container_fault(container->fd);
	if (container->finished && !container->sums.remark)
		container->sums.remark = "there is no file in it";
	if (status == BP_OK && raw && !(container->raw_name = raw_member_name(path)))
		status = error_memory(error, 256);
out:
	if (status == BP_OK)
		*out = container;
	else
		container_close(container);
	return status;
}

/* Tables, and containers that may hold some; what has a name that cannot be read may be either. */
static bool entry_counts(struct container *container)
{
	const bool folder = !container->raw_name && archive_entry_filetype(container->entry) == AE_IFDIR;
	const bool counts = !folder && (!container->path[0] || source_kind_by_name(container->path) != SOURCE_KIND_OTHER);
	container->sums.members += counts;
	container->sums.ignored += !counts && !folder;
	if (!counts && !folder)
		licences_note(&container->sums.licences, container->path, NULL);
	return counts;
}

static const char *text_or(const char *text, const char *other) { return text && *text ? text : other; }

/* Why the current entry cannot be packed, or NULL. */
static const char *entry_fault(struct container *container)
{
	struct archive_entry *entry = container->entry;
	const char *hard = archive_entry_hardlink_utf8(entry) ? archive_entry_hardlink_utf8(entry) : archive_entry_hardlink(entry);
	const bool has_bytes = archive_entry_size_is_set(entry) && archive_entry_size(entry) > 0;
	if (!container->path[0])
		return "its name cannot be read in this character set; name another with --charset";
	if (archive_entry_is_data_encrypted(entry) || archive_entry_is_metadata_encrypted(entry))
		return "encrypted; unpack it with its password first";
	if (source_kind_by_name(container->path) != SOURCE_KIND_MEASURED)
		return container->raw_name ? "what is compressed in it is no tar"
		                           : "a container within a container, which is not read; unpack the outer one first";
	if (container->raw_name)
		return NULL;
	if (hard && !has_bytes) {
		snprintf(container->fault, sizeof container->fault,
		         "a hard link to %s, stored without its bytes; store the file itself (tar --hard-dereference)",
		         text_or(hard, "another member"));
		return container->fault;
	}
	if (archive_entry_filetype(entry) == AE_IFLNK) {
		const char *soft = archive_entry_symlink_utf8(entry) ? archive_entry_symlink_utf8(entry) : archive_entry_symlink(entry);
		snprintf(container->fault, sizeof container->fault,
		         "a symbolic link to %s, stored without its bytes; store the file itself (tar --dereference, zip without -y)",
		         text_or(soft, "another file"));
		return container->fault;
	}
	return hard || archive_entry_filetype(entry) == AE_IFREG ? NULL : "a FIFO or a device, not a file";
}

bp_status container_next(struct container *container, struct container_member *member, bool *more, bp_error *error)
{
	const locale_t before = locale_enter(container);
	bp_status status;
	do
		status = entry_next(container, more, error);
	while (status == BP_OK && *more && !entry_counts(container));
	if (status == BP_OK && *more) {
		member->path = container->path;
		member->ordinal = container->next - 1;
		member->bytes = archive_entry_size_is_set(container->entry) ? (uint64_t)archive_entry_size(container->entry) : UINT64_MAX;
		member->fault = entry_fault(container);
	}
	locale_leave(before);
	return status;
}

const struct container_sums *container_sums(const struct container *container) { return &container->sums; }

bool container_ahead(const struct container *container, uint32_t ordinal)
{
	return ordinal >= container->next || (container->current && ordinal == container->next - 1);
}

bp_status container_seek(struct container *container, uint32_t ordinal, bp_error *error)
{
	bp_status status = BP_OK;
	bool more = container->current;
	if (!container_ahead(container, ordinal))
		return error_argument(error, "member %u lies behind", ordinal);
	const locale_t before = locale_enter(container);
	while (container->next <= ordinal && !container->finished)
		status = entry_next(container, &more, error); /* one bad entry on the way does not bar the others */
	locale_leave(before);
	if (container->next <= ordinal && status == BP_OK)
		return error_set(error, BP_ERROR_NOT_FOUND, BP_NO_OFFSET, "the container ends before member %u; was it replaced?",
		                 ordinal);
	return status;
}

bp_status container_read(void *user, void *bytes, size_t capacity, size_t *read, bp_error *error)
{
	struct container *container = user;
	la_ssize_t count;
	container->current = false;
	do
		count = archive_read_data(container->archive, bytes, capacity);
	while (count == ARCHIVE_RETRY);
	if (count < 0)
		return refuse(container, "damaged", error);
	*read = (size_t)count;
	return BP_OK;
}

void container_close(struct container *container)
{
	if (!container)
		return;
	if (container->archive)
		archive_read_free(container->archive);
	if (container->fd >= 0)
		close(container->fd);
	if (container->locale)
		freelocale(container->locale);
	licences_free(&container->sums.licences);
	free(container->raw_name);
	free(container->path);
	free(container);
}
