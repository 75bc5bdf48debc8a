#include "folder.h"

#include "error.h"
#include "output_check.h"
#include "progress.h"
#include "report.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* 0, or an errno. */
static int folder_make_one(const char *path)
{
	struct stat facts;
	if (mkdir(path, 0777) == 0)
		return 0;
	int reason = errno;
	if (reason != EEXIST)
		return reason;
	return stat(path, &facts) == 0 && S_ISDIR(facts.st_mode) ? 0 : ENOTDIR;
}

/* The folder and those above it; true when it is there afterwards. Says why not. */
static bool folder_create(const char *path)
{
	char *part = strdup(path);
	int reason = !part ? ENOMEM : !*part ? ENOENT : 0;

	for (char *slash = part; !reason && slash;) {
		slash = strchr(slash + 1, '/');
		if (slash)
			*slash = '\0';
		reason = folder_make_one(part);
		if (slash)
			*slash = '/';
	}
	free(part);
	if (reason) {
		bp_error error;
		error_set(&error, BP_ERROR_IO, BP_NO_OFFSET, "cannot create the folder: %s", strerror(reason));
		report_error(path, NULL, &error);
	}
	return !reason;
}

char *folder_path(const char *folder, const char *name, const char *suffix)
{
	char *path = NULL;
	return asprintf(&path, "%s/%s.%s", folder, name, suffix) < 0 ? NULL : path;
}

/* Whether files can be made in the folder: one that never gets a name tells. */
static bool folder_check(const char *folder)
{
	bp_error error;
	int fd = -1;
	char *path = folder_path(folder, ".brdfpack", "check");
	const bp_status status = path ? output_scratch_open(path, &fd, &error) : error_memory(&error, strlen(folder));
	if (fd >= 0)
		close(fd);
	free(path);
	if (status) {
		bp_error here; /* the reason, behind the name that means nothing to anybody */
		const char *reason = strstr(error.message, ".brdfpack.check: ");
		error_set(&here, status, BP_NO_OFFSET, "%s", reason ? reason + strlen(".brdfpack.check: ") : error.message);
		report_error(folder, NULL, &here);
	}
	return !status;
}

/* What is at the n-th name: nothing (0), just what would be written (1), something that must stay (-1, and said so). */
static int name_look(const struct folder_set *set, uint64_t n)
{
	const char *name = set->name(set->user, n);
	char *path = name ? folder_path(set->folder, name, set->suffix) : NULL;
	struct output_file there;
	struct stat about;
	bp_error error;
	int found = 0;
	if (path && lstat(path, &about) == 0) {
		bp_status status = output_file_open(path, OUTPUT_COMPARE, &there, &error);
		output_file_discard(&there);
		if (status) { /* not a file, a link to nothing ... */
			report_error(path, NULL, &error);
			found = -1;
		} else if (!set->force) {
			status = set->write(set->user, n, path, OUTPUT_COMPARE, &error);
			found = !status ? 1 : status == BP_ERROR_ARGUMENT ? -1 : 0; /* what cannot be had is told when it should be written */
			if (found < 0)
				output_taken_report(path);
		}
	}
	free(path);
	return found;
}

static bool name_write(const struct folder_set *set, uint64_t n)
{
	const char *name = set->name(set->user, n);
	char *path = folder_path(set->folder, name ? name : "", set->suffix);
	bp_error error;
	const bp_status status = path ? set->write(set->user, n, path, set->force ? OUTPUT_REPLACE : OUTPUT_NEW, &error)
	                              : error_memory(&error, strlen(set->folder));
	if (status)
		set->failed(set->user, n, &error);
	free(path);
	return !status;
}

bool folder_write(const struct folder_set *set)
{
	uint8_t *there = calloc(set->count ? (size_t)set->count : 1, 1); /* names whose file is as it should be */
	bool free_names = true, whole = true;
	if (!there) {
		report_text("out of memory");
		return false;
	}
	if (set->count > 0 && !(folder_create(set->folder) && folder_check(set->folder))) {
		free(there);
		return false;
	}
	uint64_t count = 0; /* a walk ends where a name cannot be told: the index fails, whatever number it promised */
	for (; count < set->count && set->name(set->user, count); count++) {
		const int found = name_look(set, count);
		there[count] = found > 0;
		free_names &= found >= 0;
	}
	count += count < set->count;
	progress_start(count > 1);
	for (uint64_t n = 0; n < count && free_names; n++) {
		progress_show(n, count, (double)n / (double)count);
		whole &= there[n] || name_write(set, n);
	}
	progress_stop();
	free(there);
	return free_names && whole;
}
