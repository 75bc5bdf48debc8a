#include "system.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "error.h"

#ifdef BP_PORTABLE

#include <limits.h>
#include <stdio.h>

struct system_file {
	FILE *stream;
};

bp_status system_file_open(const char *path, struct system_file **out, uint64_t *bytes, bp_error *error)
{
	bp_status status = BP_OK;
	struct system_file *file = malloc(sizeof *file);
	if (!file)
		return error_memory(error, sizeof *file);
	file->stream = fopen(path, "rb");
	const long end = file->stream && fseek(file->stream, 0, SEEK_END) == 0 ? ftell(file->stream) : -1;
	if (end < 0)
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot open: %s", strerror(errno));
	else if (end == LONG_MAX)
		status = error_set(error, BP_ERROR_NOT_OURS, BP_NO_OFFSET, "not a regular file");
	if (status) {
		system_file_close(file);
		return status;
	}
	*bytes = (uint64_t)end;
	*out = file;
	return BP_OK;
}

bp_status system_file_read(struct system_file *file, uint64_t offset, void *bytes, size_t count, size_t *got, bp_error *error)
{
	*got = 0;
	if (offset > LONG_MAX || fseek(file->stream, (long)offset, SEEK_SET) != 0)
		return error_set(error, BP_ERROR_IO, offset, "%s", strerror(errno));
	*got = fread(bytes, 1, count, file->stream);
	return ferror(file->stream) ? error_set(error, BP_ERROR_IO, offset + *got, "%s", strerror(errno)) : BP_OK;
}

uint64_t system_file_bytes(struct system_file *file, uint64_t otherwise)
{
	const long end = fseek(file->stream, 0, SEEK_END) == 0 ? ftell(file->stream) : -1;
	return end < 0 ? otherwise : (uint64_t)end;
}

void system_file_close(struct system_file *file)
{
	if (file && file->stream)
		fclose(file->stream);
	free(file);
}

void *system_alloc(size_t bytes, size_t alignment)
{
	return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

void system_prefer_huge(void *start, size_t bytes) { (void)start, (void)bytes; }

double system_thread_seconds(void) { return (double)clock() / CLOCKS_PER_SEC; }

#else

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

struct system_file {
	int fd;
};

bp_status system_file_open(const char *path, struct system_file **out, uint64_t *bytes, bp_error *error)
{
	struct stat found;
	bp_status status = BP_OK;
	struct system_file *file = malloc(sizeof *file);
	if (!file)
		return error_memory(error, sizeof *file);
	/* Not blocking, so that a FIFO is refused rather than waited for. */
	file->fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
	if (file->fd < 0 || fstat(file->fd, &found) != 0)
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot open: %s", strerror(errno));
	else if (!S_ISREG(found.st_mode))
		status = error_set(error, BP_ERROR_NOT_OURS, BP_NO_OFFSET, "not a regular file");
	if (status) {
		system_file_close(file);
		return status;
	}
	*bytes = (uint64_t)found.st_size;
	*out = file;
	return BP_OK;
}

bp_status system_file_read(struct system_file *file, uint64_t offset, void *bytes, size_t count, size_t *got, bp_error *error)
{
	*got = 0;
	while (*got < count) {
		const ssize_t read = pread(file->fd, (uint8_t *)bytes + *got, count - *got, (off_t)(offset + *got));
		if (read < 0 && errno == EINTR)
			continue;
		if (read < 0)
			return error_set(error, BP_ERROR_IO, offset + *got, "%s", strerror(errno));
		if (read == 0)
			break;
		*got += (size_t)read;
	}
	return BP_OK;
}

uint64_t system_file_bytes(struct system_file *file, uint64_t otherwise)
{
	struct stat now;
	return fstat(file->fd, &now) == 0 ? (uint64_t)now.st_size : otherwise;
}

void system_file_close(struct system_file *file)
{
	if (file && file->fd >= 0)
		close(file->fd);
	free(file);
}

void *system_alloc(size_t bytes, size_t alignment)
{
	void *block = NULL;
	return posix_memalign(&block, alignment, bytes) == 0 ? block : NULL;
}

void system_prefer_huge(void *start, size_t bytes)
{
#ifdef MADV_HUGEPAGE
	madvise(start, bytes, MADV_HUGEPAGE);
#else
	(void)start, (void)bytes;
#endif
}

double system_thread_seconds(void)
{
	struct timespec now;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
