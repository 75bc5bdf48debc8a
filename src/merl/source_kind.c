#include "source_kind.h"

#include <fcntl.h>
#include <stdbool.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "name.h"
#include "rgl/tensor_file.h"

enum { HEAD_BYTES = 512 };

const char *const SOURCE_SUFFIXES[] = {".binary", ".bsdf", NULL};
static const char *const COMPRESSIONS[] = {".gz", ".bz2", ".xz", ".lzma", ".zst", ".Z", NULL};
static const char *const TAR[] = {".tar", NULL};
static const char *const ARCHIVES[] = {".zip", ".tar", ".tgz", ".tbz", ".tbz2", ".txz", ".tzst", NULL};

/* Containers that are not read, and parts of split ones: they may hold materials, so they are not passed over in silence. */
static const char *const FOREIGN[] = {".7z", ".rar", ".lz", ".lz4", ".lzo", ".br", ".cab", ".z01", ".001", NULL};

/* How many of the first `bytes` bytes of a name are one of these suffixes, in either case, behind something else. */
static size_t suffix_among(const char *name, size_t bytes, const char *const *suffixes)
{
	for (; *suffixes; suffixes++) {
		const size_t suffix = strlen(*suffixes);
		if (bytes > suffix && strncasecmp(name + bytes - suffix, *suffixes, suffix) == 0)
			return suffix;
	}
	return 0;
}

/* A name's bytes without what says that it is compressed. */
static size_t unpacked_bytes(const char *name) { return strlen(name) - suffix_among(name, strlen(name), COMPRESSIONS); }

enum source_kind source_kind_by_name(const char *path)
{
	const char *name = name_in_path(path);
	const size_t bytes = strlen(name), unpacked = unpacked_bytes(name);
	if (name[0] == '.')
		return SOURCE_KIND_OTHER;
	if (suffix_among(name, bytes, SOURCE_SUFFIXES))
		return SOURCE_KIND_MEASURED;
	if (suffix_among(name, bytes, ARCHIVES))
		return SOURCE_KIND_CONTAINER;
	if (suffix_among(name, bytes, FOREIGN))
		return SOURCE_KIND_FOREIGN;
	const bool holds_one = suffix_among(name, unpacked, SOURCE_SUFFIXES) || suffix_among(name, unpacked, TAR);
	return unpacked < bytes && holds_one ? SOURCE_KIND_CONTAINER : SOURCE_KIND_OTHER;
}

/* The first bytes, zeros behind the end and where there is nothing to read. */
static void head_read(const char *path, char head[HEAD_BYTES])
{
	memset(head, 0, HEAD_BYTES);
	const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
	if (fd < 0)
		return;
	if (read(fd, head, HEAD_BYTES) < 0)
		head[0] = '\0';
	close(fd);
}

bool source_is_tensor_file(const char *path)
{
	char head[HEAD_BYTES];
	head_read(path, head);
	return memcmp(head, TENSOR_MAGIC, TENSOR_MAGIC_BYTES) == 0;
}

enum source_kind source_kind_by_content(const char *path)
{
	static const struct {
		const char *bytes;
		size_t count, offset;
	} MAGIC[] = {
		{"PK\3\4", 4, 0},
		{"PK\5\6", 4, 0},
		{"\x1f\x8b", 2, 0},
		{"\x1f\x9d", 2, 0},
		{"BZh", 3, 0},
		{"\xfd"
	     "7zXZ",
	     5, 0},
		{"\x28\xb5\x2f\xfd", 4, 0},
		{"ustar", 5, 257},
		{"\x5d\0\0", 3, 0},
		{"PK\7\10", 4, 0},
		{"7z\xbc\xaf", 4, 0},
		{"Rar!", 4, 0},
	};
	static const unsigned char MERL[12] = {90, 0, 0, 0, 90, 0, 0, 0, 180, 0, 0, 0};
	char head[HEAD_BYTES];
	head_read(path, head);
	if (memcmp(head, MERL, sizeof MERL) == 0 || memcmp(head, TENSOR_MAGIC, TENSOR_MAGIC_BYTES) == 0)
		return SOURCE_KIND_MEASURED;
	for (size_t n = 0; n < sizeof MAGIC / sizeof *MAGIC; n++)
		if (memcmp(head + MAGIC[n].offset, MAGIC[n].bytes, MAGIC[n].count) == 0)
			return SOURCE_KIND_CONTAINER;
	return source_kind_by_name(path) == SOURCE_KIND_CONTAINER ? SOURCE_KIND_CONTAINER : SOURCE_KIND_MEASURED;
}

size_t source_suffix_bytes(const char *name)
{
	const size_t unpacked = unpacked_bytes(name), suffix = suffix_among(name, unpacked, SOURCE_SUFFIXES);
	return suffix ? suffix + strlen(name) - unpacked : 0;
}

void source_stem(const char *path, char name[SOURCE_STEM_BYTES])
{
	const char *base = name_in_path(path);
	size_t bytes = unpacked_bytes(base), dot = bytes;
	while (dot > 0 && base[dot - 1] != '.')
		dot--;
	if (dot > 1) /* x.binary, not .binary */
		bytes = dot - 1;
	if (bytes >= SOURCE_STEM_BYTES)
		bytes = SOURCE_STEM_BYTES - 1;
	memcpy(name, base, bytes);
	name[bytes] = '\0';
}
