#include "temporary.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.h"

enum { STEM_BYTES_MAX = 200, TRIES = 1000 };

/* The folder's length in path, the last slash included; 0: the current folder. */
static size_t folder_bytes(const char *path)
{
	const char *slash = strrchr(path, '/');
	return slash ? (size_t)(slash - path) + 1 : 0;
}

static bp_status target_resolve(const char *path, char **out, bp_error *error)
{
	struct stat found;
	char *resolved;
	if (!path || !*path)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "the output path is empty");
	if (lstat(path, &found) == 0) {
		if (S_ISLNK(found.st_mode)) {
			resolved = realpath(path, NULL);
			if (!resolved)
				return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: a link that cannot be followed: %s", path,
				                 strerror(errno));
			if (stat(resolved, &found) != 0 || !S_ISREG(found.st_mode)) {
				free(resolved);
				return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: not a regular file", path);
			}
			*out = resolved;
			return BP_OK;
		}
		if (!S_ISREG(found.st_mode))
			return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: is %s, not a regular file", path,
			                 S_ISDIR(found.st_mode) ? "a folder" : "a special file");
	} else if (path[strlen(path) - 1] == '/') {
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: names a folder, not a file", path);
	}
	resolved = strdup(path);
	if (!resolved)
		return error_memory(error, strlen(path) + 1);
	*out = resolved;
	return BP_OK;
}

/* Locks belong to the process, so they end with it and do not pass to forked workers. */
static int file_lock(int fd)
{
	struct flock lock = { .l_type = F_WRLCK, .l_whence = SEEK_SET };
	return fcntl(fd, F_SETLK, &lock);
}

/* A path of the target's folder: `folder` NAME. */
static char *path_beside(const char *target, const char *name)
{
	size_t folder = folder_bytes(target), bytes = folder + strlen(name) + 1;
	char *path = malloc(bytes);
	if (path) {
		memcpy(path, target, folder);
		memcpy(path + folder, name, bytes - folder);
	}
	return path;
}

static int stem_print(const char *target, char stem[STEM_BYTES_MAX + 3])
{
	return snprintf(stem, STEM_BYTES_MAX + 3, ".%.*s.", STEM_BYTES_MAX, target + folder_bytes(target));
}

/* Is `name` a temporary file of this target, made by another process? */
static bool name_is_stale_candidate(const char *name, const char *stem)
{
	long process;
	int number, end = 0;
	size_t stem_bytes = strlen(stem);
	if (strncmp(name, stem, stem_bytes) != 0)
		return false;
	if (sscanf(name + stem_bytes, "%ld-%d.partial%n", &process, &number, &end) != 2 || !end || name[stem_bytes + (size_t)end])
		return false;
	return process != (long)getpid();
}

/* Best effort: what cannot be removed stays. */
static void remove_stale(const char *target)
{
	char stem[STEM_BYTES_MAX + 3];
	char *folder_path = path_beside(target, folder_bytes(target) ? "" : ".");
	DIR *folder = folder_path ? opendir(folder_path) : NULL;
	struct dirent *entry;
	stem_print(target, stem);
	while (folder && (entry = readdir(folder))) {
		char *path;
		int fd;
		if (!name_is_stale_candidate(entry->d_name, stem))
			continue;
		path = path_beside(target, entry->d_name);
		fd = path ? open(path, O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK) : -1;
		if (fd >= 0) {
			if (file_lock(fd) == 0)
				unlink(path);
			close(fd);
		}
		free(path);
	}
	if (folder)
		closedir(folder);
	free(folder_path);
}

static bp_status create_locked(struct temporary_file *file, bp_error *error)
{
	static _Atomic int next_number; /* two writers of one process get two names */
	char stem[STEM_BYTES_MAX + 3], name[STEM_BYTES_MAX + 64];
	stem_print(file->target, stem);
	for (int i = 0; i < TRIES; i++) {
		struct stat made;
		snprintf(name, sizeof name, "%s%ld-%d.partial", stem, (long)getpid(), next_number++);
		free(file->path);
		file->path = path_beside(file->target, name);
		if (!file->path)
			return error_memory(error, strlen(file->target) + sizeof name);
		file->fd = open(file->path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
		if (file->fd < 0 && errno == EEXIST)
			continue;
		if (file->fd < 0)
			break;
		/* A folder without locks is legal; another writer may have taken the unlocked file for a stale one. */
		if (file_lock(file->fd) == 0 && fstat(file->fd, &made) == 0 && made.st_nlink == 0) {
			close(file->fd);
			file->fd = -1;
			continue;
		}
		return BP_OK;
	}
	return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot create a file there: %s", file->target, strerror(errno));
}

bp_status temporary_create(const char *target, struct temporary_file *out, bp_error *error)
{
	struct temporary_file file = { .fd = -1 };
	bp_status status = target_resolve(target, &file.target, error);
	if (!status) {
		remove_stale(file.target);
		status = create_locked(&file, error);
	}
	if (status) {
		free(file.path);
		file.path = NULL;
		temporary_discard(&file);
		return status;
	}
	*out = file;
	return BP_OK;
}

static bp_status folder_sync(const char *target, bp_error *error)
{
	char *folder = path_beside(target, folder_bytes(target) ? "" : ".");
	int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
	bp_status status = BP_OK;
	/* Some file systems refuse to sync a folder (EINVAL); they have nothing to sync. */
	if (fd < 0 || (fsync(fd) != 0 && errno != EINVAL))
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot sync its folder: %s", target, strerror(errno));
	if (fd >= 0)
		close(fd);
	free(folder);
	return status;
}

bp_status temporary_commit(struct temporary_file *file, bp_error *error)
{
	int closed;
	if (fsync(file->fd) != 0)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot sync: %s", file->target, strerror(errno));
	/* Renamed while still locked, so that nobody takes it for a stale one in between. */
	if (rename(file->path, file->target) != 0)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot rename the finished file to it: %s", file->target,
		                 strerror(errno));
	free(file->path);
	file->path = NULL;
	closed = close(file->fd);
	file->fd = -1;
	if (closed != 0)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot close: %s", file->target, strerror(errno));
	return folder_sync(file->target, error);
}

void temporary_discard(struct temporary_file *file)
{
	if (file->path)
		unlink(file->path);
	if (file->fd >= 0)
		close(file->fd);
	free(file->path);
	free(file->target);
	*file = (struct temporary_file){ .fd = -1 };
}
