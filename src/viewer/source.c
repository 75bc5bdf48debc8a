/*
 * The reader's four calls of the system, answered by a callback: in WebAssembly there is no file system, and these definitions come
 * before the C library's. A descriptor is the number of a source, and so is the path that opens it.
 */
#include "source.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>

enum { SOURCES_MAX = 64, FIRST = 3 };
static bp_source sources[SOURCES_MAX]; /* free where read is NULL */

int open(const char *path, int flags, ...);
int fstat(int fd, struct stat *out);
ssize_t pread(int fd, void *bytes, size_t count, off_t offset);
int close(int fd);

int open(const char *path, int flags, ...)
{
	(void)flags;
	return FIRST + atoi(path);
}

int fstat(int fd, struct stat *out)
{
	memset(out, 0, sizeof *out);
	out->st_mode = S_IFREG;
	out->st_size = (off_t)sources[fd - FIRST].bytes;
	return 0;
}

ssize_t pread(int fd, void *bytes, size_t count, off_t offset)
{
	const bp_source *source = &sources[fd - FIRST];
	const uint64_t at = (uint64_t)offset, left = at < source->bytes ? source->bytes - at : 0;
	const size_t take = count < left ? count : (size_t)left;
	if (take && source->read(source->user, at, bytes, take) != 0) {
		errno = EIO;
		return -1;
	}
	return (ssize_t)take;
}

int close(int fd)
{
	sources[fd - FIRST] = (bp_source){0};
	return 0;
}

bp_status bp_archive_open_source(const bp_source *source, bp_archive **out, bp_error *error)
{
	char path[16];
	int n = 0;
	while (n < SOURCES_MAX - 1 && sources[n].read)
		n++;
	sources[n] = *source;
	snprintf(path, sizeof path, "%d", n);
	return bp_archive_open(path, out, error);
}
