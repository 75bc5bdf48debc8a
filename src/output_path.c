#include "output_path.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bytes.h"
#include "error.h"
#include "name.h"

char *output_path_beside(const char *target, const char *name)
{
	const size_t folder = (size_t)(name_in_path(target) - target), bytes = folder + strlen(name) + 1;
	char *path = malloc(bytes);
	if (path) {
		memcpy(path, target, folder);
		memcpy(path + folder, name, bytes - folder);
	}
	return path;
}

char *output_path_folder(const char *target) { return output_path_beside(target, name_in_path(target) > target ? "" : "."); }

bp_status output_path_resolve(const char *path, char **out, bool *found, struct stat *about, bp_error *error)
{
	*found = false;
	if (!*path)
		return error_argument(error, "the output path is empty");
	*found = lstat(path, about) == 0;
	if (!*found && errno == ENAMETOOLONG)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot create: %s", path, strerror(errno));
	if (!*found && path[strlen(path) - 1] == '/')
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: names a folder, not a file", path);
	const bool link = *found && S_ISLNK(about->st_mode);
	char *target = link ? realpath(path, NULL) : strdup(path);
	if (!target && link && errno != ENOMEM)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: a link that leads to nothing: %s", path, strerror(errno));
	if (!target)
		return error_memory(error, strlen(path) + 1);
	bp_status status = BP_OK;
	if (link && stat(target, about) != 0)
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot follow the link: %s", path, strerror(errno));
	else if (*found && !S_ISREG(about->st_mode))
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: is %s, not a regular file", path,
		                   S_ISDIR(about->st_mode) ? "a folder" : "a special file");
	if (status)
		free(target);
	else
		*out = target;
	return status;
}

#define UNFINISHED ".brdfpack-"

void output_path_stem(const char *target, char stem[OUTPUT_STEM_BYTES])
{
	const char *name = name_in_path(target);
	snprintf(stem, OUTPUT_STEM_BYTES, UNFINISHED "%08x-", bytes_crc32(name, strlen(name)));
}

bool output_path_unfinished(const char *path) { return !strncmp(name_in_path(path), UNFINISHED, sizeof UNFINISHED - 1); }

int output_path_lock(int fd)
{
	struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
	return fcntl(fd, F_SETLK, &lock);
}
