/*
 * The archive reader on arbitrary bytes: header, index, heads, sections, evaluation, listing, extraction, and, for one length of
 * eight, recovery. Three of four lengths have their checksums mended.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "archive_walk.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	static int fd = -1;
	static char path[64];
	uint8_t *copy = malloc(count + 1);
	if (fd < 0) {
		fd = memfd_create("fuzz", 0);
		snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
	}
	memcpy(copy, data, count);
	if (count % 4)
		archive_mend(copy, count);
	if (ftruncate(fd, 0) != 0 || pwrite(fd, copy, count, 0) != (ssize_t)count)
		abort();
	archive_walk(path, 0, 8, WALK_LIST | WALK_EXTRACT, NULL, NULL);
	if (count % 8 == 3) {
		struct recovery saved;
		archive_rescue(path, 0, 8, NULL, NULL, &saved);
	}
	free(copy);
	return 0;
}
