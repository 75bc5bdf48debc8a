/*
 * The archive reader on arbitrary bytes: header, index, heads, sections, evaluation, listing, extraction, and, for one length of
 * eight, recovery. Three of four lengths have their checksums mended.
 */
#include <stdlib.h>
#include <string.h>

#include "archive_walk.h"
#include "fuzz_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	uint8_t *copy = malloc(count + 1);
	memcpy(copy, data, count);
	if (count % 4)
		archive_mend(copy, count);
	const char *path = fuzz_file(copy, count);
	archive_walk(path, 0, 8, WALK_LIST | WALK_EXTRACT, NULL, NULL);
	if (count % 8 == 3) {
		struct recovery saved;
		archive_rescue(path, 0, 8, NULL, NULL, &saved);
	}
	free(copy);
	return 0;
}
