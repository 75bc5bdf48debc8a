#include "folder.h"

#include "error.h"
#include "report.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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

bool folder_create(const char *path)
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
