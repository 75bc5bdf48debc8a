/*
 * The archive reader: the input is a whole archive whose checksums are mended. Opens, lists, finds and verifies it.
 *
 * See tests/fuzz/run.
 */
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "archive/reader.h"
#include "mend.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);

static void read_all(const char *path)
{
	bp_archive *archive = NULL;
	if (bp_archive_open(path, &archive, NULL) != BP_OK)
		return;
	for (uint64_t i = 0; i < bp_archive_count(archive) && i < 40; i++) {
		bp_material_info info = { .struct_bytes = sizeof info };
		char name[BP_NAME_BYTES_MAX + 1];
		uint64_t found;
		if (bp_archive_name(archive, i, name, NULL) == BP_OK && bp_archive_find(archive, name, &found, NULL) == BP_OK && found != i)
			abort();
		if (bp_archive_info(archive, i, &info, NULL) == BP_OK && strcmp(info.name, name) != 0)
			abort();
	}
	bp_archive_verify(archive, 0, NULL, NULL, NULL);
	bp_archive_close(archive);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	uint8_t *file = malloc(count + 1);
	int fd = memfd_create("fuzz", MFD_CLOEXEC);
	char path[64];
	if (fd < 0 || !file)
		abort();
	memcpy(file, data, count);
	mend_archive(file, count);
	if (write(fd, file, count) != (ssize_t)count)
		abort();
	snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
	read_all(path);
	close(fd);
	free(file);
	return 0;
}
