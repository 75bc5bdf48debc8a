#include "not_archive.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "archive/format.h"
#include "bytes.h"
#include "merl/foreign.h"
#include "merl/merl_file.h"
#include "merl/source_kind.h"
#include "rgl/tensor_file.h"

static bool is_measured(const uint8_t *head, size_t count, uint64_t file_bytes)
{
	struct lattice_dims dims;
	if (count >= TENSOR_MAGIC_BYTES && memcmp(head, TENSOR_MAGIC, TENSOR_MAGIC_BYTES) == 0)
		return true;
	if (count < 12)
		return false;
	dims = (struct lattice_dims){load_u32(head), load_u32(head + 4), load_u32(head + 8)};
	return lattice_dims_legal(dims) && merl_file_bytes(dims) == file_bytes;
}

static const char *file_kind(const char *path, uint64_t file_bytes)
{
	uint8_t head[FOREIGN_HEAD_BYTES];
	if (file_bytes == 0)
		return "an empty file";
	FILE *file = fopen(path, "rbe");
	if (!file)
		return NULL;
	const size_t count = fread(head, 1, sizeof head, file);
	fclose(file);
	if (is_measured(head, count, file_bytes))
		return "a measured file: `brdfpack build` packs it";
	if (source_kind_by_content(path) == SOURCE_KIND_CONTAINER)
		return "a tar, zip or compressed file: `brdfpack build` packs the measured files in it";
	if (count >= 4 && memcmp(head, ARCHIVE_MAGIC, 4) == 0)
		return "one with other line ends: copy it as binary, not as text";
	return foreign_kind(head, count);
}

void not_archive_tell(const char *path, char *text, size_t bytes)
{
	struct stat found;
	const char *kind = NULL;
	text[0] = '\0';
	if (stat(path, &found) != 0)
		return;
	if (S_ISDIR(found.st_mode))
		snprintf(text, bytes, ", but a folder: `brdfpack build` packs the measured files in it");
	else if (S_ISREG(found.st_mode))
		kind = file_kind(path, (uint64_t)found.st_size);
	if (kind)
		snprintf(text, bytes, ", but as %s", kind);
}
