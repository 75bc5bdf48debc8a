/*
 * fault_shim.c: a library to preload. The FAULT_AT-th call of the kind FAULT_CALL in a process fails, once (FAULT_ALWAYS: and
 * all that follow). Kinds: alloc (malloc, calloc, realloc, posix_memalign, aligned_alloc), write (write, pwrite), read (read, pread),
 * sync (fsync), rename, open.
 */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

static char wanted; /* first letter of the kind; 0: none */
static long at, always;
static atomic_long calls;

static void arm(const char *call, long number)
{
	at = number;
	wanted = call && number > 0 ? call[0] : 0;
	if (call && !strcmp(call, "rename"))
		wanted = 'n';
	atomic_store(&calls, 0);
}

__attribute__((constructor)) static void begin(void)
{
	const char *number = getenv("FAULT_AT");
	always = getenv("FAULT_ALWAYS") != NULL;
	arm(getenv("FAULT_CALL"), number ? atol(number) : 0);
}

/* For a program that looks these two up: the at-th call from now on; and whether it is still to come. */
void fault_arm(const char *call, long number);
int fault_armed(void);
__attribute__((visibility("default"))) void fault_arm(const char *call, long number) { arm(call, number); }
__attribute__((visibility("default"))) int fault_armed(void) { return atomic_load(&calls) < at; }

static int fails(char kind)
{
	if (kind != wanted)
		return 0;
	const long n = atomic_fetch_add(&calls, 1) + 1;
	return n == at || (always && n > at);
}

void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t n, size_t bytes);
void *__libc_realloc(void *old, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);

#define EXPORT __attribute__((visibility("default")))
#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

EXPORT void *malloc(size_t bytes)
{
	if (fails('a'))
		return errno = ENOMEM, NULL;
	return __libc_malloc(bytes);
}
EXPORT void *calloc(size_t n, size_t bytes)
{
	if (fails('a'))
		return errno = ENOMEM, NULL;
	return __libc_calloc(n, bytes);
}
EXPORT void *realloc(void *old, size_t bytes)
{
	if (fails('a'))
		return errno = ENOMEM, NULL;
	return __libc_realloc(old, bytes);
}
EXPORT int posix_memalign(void **block, size_t alignment, size_t bytes)
{
	void *found = fails('a') ? NULL : __libc_memalign(alignment, bytes);
	if (!found)
		return ENOMEM;
	*block = found;
	return 0;
}
EXPORT void *aligned_alloc(size_t alignment, size_t bytes)
{
	if (fails('a'))
		return errno = ENOMEM, NULL;
	return __libc_memalign(alignment, bytes);
}
EXPORT ssize_t write(int fd, const void *bytes, size_t count)
{
	if (fd > 2 && fails('w'))
		return errno = ENOSPC, -1;
	return REAL(write)(fd, bytes, count);
}
EXPORT ssize_t pwrite(int fd, const void *bytes, size_t count, off_t offset)
{
	if (fails('w'))
		return errno = ENOSPC, -1;
	return REAL(pwrite)(fd, bytes, count, offset);
}
EXPORT ssize_t read(int fd, void *bytes, size_t count)
{
	if (fails('r'))
		return errno = EIO, -1;
	return REAL(read)(fd, bytes, count);
}
EXPORT ssize_t pread(int fd, void *bytes, size_t count, off_t offset)
{
	if (fails('r'))
		return errno = EIO, -1;
	return REAL(pread)(fd, bytes, count, offset);
}
EXPORT int fsync(int fd)
{
	if (fails('s'))
		return errno = EIO, -1;
	return REAL(fsync)(fd);
}
EXPORT int rename(const char *from, const char *to)
{
	if (fails('n'))
		return errno = EACCES, -1;
	return REAL(rename)(from, to);
}
EXPORT int open(const char *path, int flags, ...)
{
	va_list more;
	va_start(more, flags);
	const unsigned mode = va_arg(more, unsigned);
	va_end(more);
	if (fails('o'))
		return errno = EMFILE, -1;
	return ((int (*)(const char *, int, ...))dlsym(RTLD_NEXT, "open"))(path, flags, mode);
}
