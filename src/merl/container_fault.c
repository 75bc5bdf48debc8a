#include "container_fault.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bytes.h"

/* The end record of a zip: fixed part, and the longest comment behind it. */
enum { HEAD_BYTES = 512, ZIP_END_BYTES = 22, ZIP_COMMENT_MAX = 65535, CHUNK_BYTES = 1 << 16 };

#define ZEROS "holds nothing but zeros: was the download completed?"

/* Whether the file is zeros from this byte to its end. */
static bool all_zeros(int fd, off_t at)
{
	uint8_t chunk[CHUNK_BYTES];
	for (ssize_t got; (got = pread(fd, chunk, sizeof chunk, at)) > 0; at += got)
		for (ssize_t n = 0; n < got; n++)
			if (chunk[n])
				return false;
	return true;
}

#define REST "something else stands behind its end in the same file, and is not read; separate them"

/* A zip's last record tells of other disks, and where the directory should stand; later: something else is before the zip. */
static const char *zip_fault(int fd, const uint8_t *head, size_t head_bytes)
{
	struct stat about;
	const off_t size = fstat(fd, &about) == 0 ? about.st_size : 0; /* not by seeking: the reader's place must stay */
	const off_t start = size > ZIP_END_BYTES + ZIP_COMMENT_MAX ? size - ZIP_END_BYTES - ZIP_COMMENT_MAX : 0;
	uint8_t *tail = malloc(ZIP_END_BYTES + ZIP_COMMENT_MAX);
	const ssize_t got = tail && size > 0 ? pread(fd, tail, (size_t)(size - start), start) : -1;
	const char *fault = NULL;
	for (ssize_t at = got - ZIP_END_BYTES; at >= 0; at--) {
		const uint8_t *end = tail + at;
		const uint16_t comment = load_u16(end + 20);
		if (memcmp(end, "PK\5\6", 4) != 0 || at + ZIP_END_BYTES + comment > got)
			continue;
		const uint32_t disk = load_u16(end + 4), bytes = load_u32(end + 12), offset = load_u32(end + 16);
		if (disk != 0 && disk != 0xFFFF)
			fault = "the last part of a split zip; join its parts first (zip -s 0 THIS.zip --out WHOLE.zip)";
		else if (bytes != UINT32_MAX && offset != UINT32_MAX && (uint64_t)(start + at) > (uint64_t)bytes + offset &&
		         head_bytes >= 4 && !memcmp(head, "PK\3\4", 4))
			fault = "another zip stands before this one in the same file, and its members are not read; separate them";
		else if (!all_zeros(fd, start + at + ZIP_END_BYTES + comment))
			fault = REST;
		break;
	}
	free(tail);
	return fault;
}

static bool begins(const char *head, const char *word) { return strncasecmp(head, word, strlen(word)) == 0; }

const char *container_fault(int fd)
{
	static const struct {
		const char *bytes;
		size_t count;
		const char *fault;
	} MAGIC[] = {
		{"PK\7\10", 4, "a part of a split zip; join its parts first (zip -s 0 LAST.zip --out WHOLE.zip)"},
		{"PK00PK\3\4", 8, "a part of a split zip; join its parts first (zip -s 0 LAST.zip --out WHOLE.zip)"},
		{"7z\xBC\xAF\x27\x1C", 6, "a 7z archive, which is not read; unpack it first"},
		{"Rar!\x1A\7", 6, "a RAR archive, which is not read; unpack it first"},
		{"version https://git-lfs", 23, "a pointer of Git LFS, not the file itself; fetch it with git lfs pull"},
	};
	char head[HEAD_BYTES + 1];
	const ssize_t got = pread(fd, head, HEAD_BYTES, 0);
	if (got < 0)
		return NULL;
	head[got] = '\0';
	if (got == 0)
		return "an empty file";
	for (size_t n = 0; n < sizeof MAGIC / sizeof *MAGIC; n++)
		if ((size_t)got >= MAGIC[n].count && !memcmp(head, MAGIC[n].bytes, MAGIC[n].count))
			return MAGIC[n].fault;
	if (!head[0] && all_zeros(fd, 0))
		return ZEROS;
	const char *text = head;
	if (begins(text, "\xEF\xBB\xBF"))
		text += 3;
	text += strspn(text, " \t\r\n");
	if (begins(text, "<!doctype html") || begins(text, "<html") || begins(text, "<head") || begins(text, "<!--"))
		return "a page of HTML: a web page was saved in place of the file; download it again";
	if (begins(text, "<?xml") || text[0] == '{')
		return "a text, as servers send for an error, in place of the file; download it again";
	return zip_fault(fd, (const uint8_t *)head, (size_t)got);
}

const char *container_rest(int fd, int64_t end) { return all_zeros(fd, (off_t)end) ? NULL : REST; }
