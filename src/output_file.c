#include "output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "descriptor.h"
#include "error.h"
#include "output_path.h"

enum { TRIES = 1000, COMPARE_BYTES = 1 << 14, MODE_BITS = 0777 };

static bp_status refuse(const char *path, const char *what, bp_error *error)
{
	return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot %s: %s", path, what, strerror(errno));
}

static bp_status refuse_taken(const char *path, bp_error *error) { return error_argument(error, "%s: is there already", path); }

/* What replaces a file is nobody else's to read before it has that file's mode. */
static mode_t mode_of(const struct output_file *out) { return out->replaces ? 0600 : 0666; }

/* An unnamed file in the folder of the target, or -1 where the system has no such thing. */
static int open_unnamed(const struct output_file *out)
{
	char *folder = output_path_folder(out->target);
	const int fd = folder ? open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, mode_of(out)) : -1;
	free(folder);
	return fd;
}

/* Tries one short name after the other until `take` makes a file of it (0), or fails for another reason than that it is taken. */
static bp_status name_find(struct output_file *out, int (*take)(struct output_file *, const char *), bp_error *error)
{
	static atomic_uint serial; /* two writers of one process get two names */
	char stem[OUTPUT_STEM_BYTES], name[2 * OUTPUT_STEM_BYTES];
	output_path_stem(out->target, stem);
	for (int n = 0; n < TRIES; n++) {
		snprintf(name, sizeof name, "%s%ld-%u", stem, (long)getpid(), atomic_fetch_add(&serial, 1));
		char *path = output_path_beside(out->target, name);
		if (!path)
			return error_memory(error, strlen(out->target) + sizeof name);
		if (take(out, path) == 0) {
			out->temporary = path;
			return BP_OK;
		}
		free(path);
		if (errno != EEXIST)
			break;
	}
	return refuse(out->target, "create a file there", error);
}

static int take_by_creating(struct output_file *out, const char *path)
{
	struct stat made;
	out->fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode_of(out));
	if (out->fd < 0)
		return -1;
	/* A folder without locks is legal; a sweep may have taken the file for a dead writer's before it was locked. */
	if (output_path_lock(out->fd) == 0 && fstat(out->fd, &made) == 0 && made.st_nlink == 0) {
		close(out->fd);
		out->fd = -1;
		errno = EEXIST;
		return -1;
	}
	return 0;
}

/* Names the unnamed file. */
static int take_by_linking(struct output_file *out, const char *path)
{
	char self[64];
	snprintf(self, sizeof self, "/proc/self/fd/%d", out->fd);
	return linkat(AT_FDCWD, self, AT_FDCWD, path, AT_SYMLINK_FOLLOW);
}

static bp_status create(struct output_file *out, bp_error *error)
{
	if (access("/proc/self/fd", X_OK) == 0) /* else it could not be given a name later */
		out->fd = open_unnamed(out);
	if (out->fd < 0)
		return name_find(out, take_by_creating, error);
	output_path_lock(out->fd);
	return BP_OK;
}

bp_status output_file_open(const char *path, enum output_rule rule, struct output_file *out, bp_error *error)
{
	*out = (struct output_file){.fd = -1, .rule = rule};
	bp_status status = output_path_resolve(path, &out->target, &out->replaces, &out->before, error);
	if (!status && rule == OUTPUT_NEW && out->replaces)
		status = refuse_taken(path, error);
	if (!status && rule == OUTPUT_COMPARE) {
		out->fd = open(out->target, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
		if (out->fd < 0)
			status = refuse(path, "open", error);
	} else if (!status) {
		status = create(out, error);
	}
	if (status)
		output_file_discard(out);
	return status;
}

/* Whether the file goes on with just these bytes; -1 on an error. */
static int same_bytes(int fd, const uint8_t *bytes, size_t count)
{
	uint8_t there[COMPARE_BYTES];
	for (size_t some; count; bytes += some, count -= some) {
		some = count < sizeof there ? count : sizeof there;
		if (descriptor_read(fd, there, some, -1) < some)
			return errno ? -1 : 0;
		if (memcmp(there, bytes, some) != 0)
			return 0;
	}
	return 1;
}

bp_status output_file_write(struct output_file *out, const void *bytes, size_t count, bp_error *error)
{
	if (out->rule == OUTPUT_COMPARE) {
		const int same = same_bytes(out->fd, bytes, count);
		return same < 0 ? refuse(out->target, "read", error) : same ? BP_OK : refuse_taken(out->target, error);
	}
	return descriptor_write(out->fd, bytes, count, -1) == count ? BP_OK : refuse(out->target, "write", error);
}

/* Mode, owner and group of the file that is replaced; who must not give files away keeps what is allowed. */
static void likeness_keep(struct output_file *out)
{
	struct stat now;
	mode_t mode;
	if (stat(out->target, &now) == 0 && S_ISREG(now.st_mode))
		out->before = now;
	else if (!out->replaces)
		return;
	mode = out->before.st_mode & MODE_BITS;
	if (fchown(out->fd, out->before.st_uid, out->before.st_gid) != 0 && fchown(out->fd, (uid_t)-1, out->before.st_gid) != 0)
		mode = (mode & ~(mode_t)070) | (mode & 07) << 3; /* what one group might do is not another's right */
	(void)!fchmod(out->fd, mode);                        /* a file system without modes is legal */
}

static bp_status file_sync(const struct output_file *out, bp_error *error)
{
	/* Some file systems have nothing to sync, and say so. */
	if (fsync(out->fd) == 0 || errno == EINVAL || errno == EOPNOTSUPP || errno == ENOSYS)
		return BP_OK;
	return refuse(out->target, "sync", error);
}

/* All bytes of one file to another. */
static bp_status bytes_copy(int from, struct output_file *to, bp_error *error)
{
	uint8_t bytes[COMPARE_BYTES];
	size_t got = sizeof bytes;
	for (off_t at = 0; got == sizeof bytes; at += (off_t)got) {
		got = descriptor_read(from, bytes, sizeof bytes, at);
		if (got < sizeof bytes && errno)
			return refuse(to->target, "read back", error);
		const bp_status status = output_file_write(to, bytes, got, error);
		if (status)
			return status;
	}
	return BP_OK;
}

/* Names the unnamed file; where that is not allowed, as in some containers, a copy has a name from the start. */
static bp_status name_give(struct output_file *out, bp_error *error)
{
	if (!name_find(out, take_by_linking, NULL))
		return BP_OK;
	const int unnamed = out->fd;
	out->fd = -1;
	bp_status status = name_find(out, take_by_creating, error);
	if (!status)
		status = bytes_copy(unnamed, out, error);
	if (!status)
		status = file_sync(out, error);
	close(unnamed);
	return status;
}

/* Takes no other file's place, not even one that has just appeared: a link fails there, where rename would not. */
static bp_status place_new(struct output_file *out, bp_error *error)
{
	int failed = link(out->temporary, out->target);
	if (!failed)
		unlink(out->temporary);
	else if (errno != EEXIST && access(out->target, F_OK) != 0) /* a file system without links */
		failed = rename(out->temporary, out->target);
	if (failed)
		return errno == EEXIST ? refuse_taken(out->target, error) : refuse(out->target, "create", error);
	return BP_OK;
}

static bp_status place_over(struct output_file *out, bp_error *error)
{
	likeness_keep(out);
	return rename(out->temporary, out->target) == 0 ? BP_OK : refuse(out->target, "replace", error);
}

static bp_status place(struct output_file *out, bp_error *error)
{
	const bool is_new = out->rule == OUTPUT_NEW;
	if (is_new && !out->temporary && take_by_linking(out, out->target) == 0)
		return BP_OK;
	if (is_new && !out->temporary && errno == EEXIST)
		return refuse_taken(out->target, error);
	bp_status status = out->temporary ? BP_OK : name_give(out, error);
	if (!status)
		status = is_new ? place_new(out, error) : place_over(out, error);
	if (!status) {
		free(out->temporary);
		out->temporary = NULL;
	}
	return status;
}

bp_status output_file_commit(struct output_file *out, bp_error *error)
{
	bp_status status = BP_OK;
	uint8_t more;
	if (out->rule == OUTPUT_COMPARE) {
		const ssize_t got = read(out->fd, &more, 1);
		status = got < 0 ? refuse(out->target, "read", error) : got > 0 ? refuse_taken(out->target, error) : BP_OK;
	} else {
		/* A network file system tells of a full disk at the close: a second descriptor hears it before the file has its place. */
		const int twin = dup(out->fd);
		if (twin >= 0 && close(twin) != 0)
			status = refuse(out->target, "write", error);
		if (!status)
			status = place(out, error);
	}
	output_file_discard(out);
	return status;
}

static void folder_sync(const char *target, bp_error *error)
{
	char *folder = output_path_folder(target);
	const int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
	if (fd < 0 || (fsync(fd) != 0 && errno != EINVAL))
		error_set(error, BP_OK, BP_NO_OFFSET,
		          "written, but its folder cannot be synced (%s): a power cut soon after may bring the old state back",
		          strerror(errno));
	if (fd >= 0)
		close(fd);
	free(folder);
}

bp_status output_file_commit_synced(struct output_file *out, bp_error *error)
{
	bp_status status = file_sync(out, error);
	/* Placed while still locked, so that nobody takes it for a dead writer's in between. */
	if (!status)
		status = place(out, error);
	if (!status) {
		const int fd = out->fd;
		out->fd = -1;
		error_set(error, BP_OK, BP_NO_OFFSET, "%s", "");
		if (close(fd) != 0)
			error_set(error, BP_OK, BP_NO_OFFSET, "written, but closing it failed: %s", strerror(errno));
		else
			folder_sync(out->target, error);
	}
	output_file_discard(out);
	return status;
}

void output_file_discard(struct output_file *out)
{
	if (out->temporary)
		unlink(out->temporary);
	if (out->fd >= 0)
		close(out->fd);
	free(out->target);
	free(out->temporary);
	*out = (struct output_file){.fd = -1};
}

bp_status output_file_write_whole(const char *path, enum output_rule rule, const void *bytes, size_t count, bp_error *error)
{
	struct output_file file;
	bp_status status = output_file_open(path, rule, &file, error);
	if (!status)
		status = output_file_write(&file, bytes, count, error);
	if (!status)
		return output_file_commit(&file, error);
	output_file_discard(&file);
	return status;
}

bp_status output_scratch_open(const char *path, int *fd, bp_error *error)
{
	struct output_file file;
	bp_status status = output_file_open(path, OUTPUT_REPLACE, &file, error);
	if (status)
		return status;
	*fd = file.fd;
	file.fd = -1;
	output_file_discard(&file);
	return BP_OK;
}
