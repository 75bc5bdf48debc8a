#include "output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "error.h"

static bp_status refuse(const struct output_file *out, const char *what, bp_error *error)
{
	return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot %s: %s", out->path, what, strerror(errno));
}

/* An unnamed file in the folder of the path, or -1 where the system has no such thing. */
static int open_unnamed(const char *path)
{
	const char *slash = strrchr(path, '/');
	if (access("/proc/self/fd", X_OK) != 0)
		return -1; /* it could not be given a name later */
	if (!slash)
		return open(".", O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
	char *folder = strndup(path, (size_t)(slash - path) + 1);
	if (!folder)
		return -1;
	const int fd = open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
	free(folder);
	return fd;
}

bp_status output_file_open(const char *path, struct output_file *out, bp_error *error)
{
	static atomic_uint serial;
	*out = (struct output_file){.fd = -1, .path = strdup(path)};
	if (!out->path || asprintf(&out->temporary, "%s.tmp-%ld-%u", path, (long)getpid(), atomic_fetch_add(&serial, 1)) < 0) {
		out->temporary = NULL;
		output_file_discard(out);
		return error_memory(error, 2 * strlen(path));
	}
	out->fd = open_unnamed(path);
	if (out->fd < 0) {
		out->fd = open(out->temporary, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
		out->named = out->fd >= 0;
	}
	if (out->fd >= 0)
		return BP_OK;
	const bp_status status = refuse(out, "create", error);
	output_file_discard(out);
	return status;
}

bp_status output_file_write(struct output_file *out, const void *bytes, size_t count, bp_error *error)
{
	const char *next = bytes;
	while (count) {
		const ssize_t written = write(out->fd, next, count);
		if (written < 0 && errno == EINTR)
			continue;
		if (written < 0)
			return refuse(out, "write", error);
		next += written;
		count -= (size_t)written;
	}
	return BP_OK;
}

/* Gives the unnamed file its temporary name; rename then replaces an older file, which a link cannot. */
static bp_status give_name(struct output_file *out, bp_error *error)
{
	char self[64];
	snprintf(self, sizeof self, "/proc/self/fd/%d", out->fd);
	int failed = linkat(AT_FDCWD, self, AT_FDCWD, out->temporary, AT_SYMLINK_FOLLOW);
	if (failed && errno == EEXIST && unlink(out->temporary) == 0) /* left by a killed process of the same number */
		failed = linkat(AT_FDCWD, self, AT_FDCWD, out->temporary, AT_SYMLINK_FOLLOW);
	if (failed)
		return refuse(out, "create", error);
	out->named = 1;
	return BP_OK;
}

bp_status output_file_commit(struct output_file *out, bp_error *error)
{
	bp_status status = out->named ? BP_OK : give_name(out, error);
	if (status != BP_OK)
		goto out;
	const int fd = out->fd;
	out->fd = -1;
	if (close(fd) != 0) { /* a network file system reports a full disk here */
		status = refuse(out, "write", error);
		goto out;
	}
	if (rename(out->temporary, out->path) != 0) {
		status = refuse(out, "replace", error);
		goto out;
	}
	out->named = 0;
out:
	output_file_discard(out);
	return status;
}

void output_file_discard(struct output_file *out)
{
	if (out->fd >= 0)
		close(out->fd);
	if (out->named)
		unlink(out->temporary);
	free(out->path);
	free(out->temporary);
	*out = (struct output_file){.fd = -1};
}
