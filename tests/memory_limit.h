/*
 * memory_limit.h: what a process may map, as a test bounds it.
 */
#ifndef TESTS_MEMORY_LIMIT_H
#define TESTS_MEMORY_LIMIT_H

#include <stdbool.h>
#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>

/* AddressSanitizer, where it is compiled in, would end the process instead of telling it that there is no memory. */
__attribute__((visibility("default"))) const char *__asan_default_options(void);
const char *__asan_default_options(void) { return "allocator_may_return_null=1"; }

/* From here on `more` bytes may be mapped beyond what is; 0: as many as there are. False where the system refuses. */
static bool memory_limit(size_t more)
{
	struct rlimit limit;
	size_t pages = 0;
	FILE *file = fopen("/proc/self/statm", "r");
	const bool known = file && fscanf(file, "%zu", &pages) == 1;
	if (file)
		fclose(file);
	if (!known || getrlimit(RLIMIT_AS, &limit) != 0)
		return false;
	limit.rlim_cur = more ? pages * (size_t)sysconf(_SC_PAGESIZE) + more : limit.rlim_max;
	return setrlimit(RLIMIT_AS, &limit) == 0;
}

#endif
