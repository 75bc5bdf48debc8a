#include "format.h"

#include <string.h>

#include "bytes.h"
#include "error.h"

enum { AT_MAJOR = 8, AT_FLAGS = 12, AT_COUNT = 24, AT_INDEX = 32, AT_RESERVED = 48, AT_CRC = 60 };

void archive_header_write(const struct archive_header *header, uint8_t bytes[ARCHIVE_HEADER_BYTES])
{
	struct byte_buffer out = {.bytes = bytes, .capacity = ARCHIVE_HEADER_BYTES};
	write_bytes(&out, ARCHIVE_MAGIC, ARCHIVE_MAGIC_BYTES);
	write_u16(&out, ARCHIVE_MAJOR);
	write_u16(&out, ARCHIVE_MINOR);
	write_u32(&out, 0); /* flags */
	write_u64(&out, header->file_bytes);
	write_u64(&out, header->count);
	write_u64(&out, header->index_offset);
	write_u32(&out, header->page_count);
	write_u32(&out, header->depth);
	write_zeros(&out, AT_CRC - AT_RESERVED);
	write_u32(&out, bytes_crc32(bytes, AT_CRC));
}

/* Index and records fit the file and each other. */
static bp_status header_check(const struct archive_header *header, uint64_t file_bytes, bp_error *error)
{
	uint64_t pages_bytes = (uint64_t)header->page_count * PAGE_BYTES;
	if (header->file_bytes != file_bytes)
		return error_set(error, BP_ERROR_CORRUPT, file_bytes < header->file_bytes ? file_bytes : header->file_bytes,
		                 "the file has %llu bytes, its header says %llu: it was cut or extended", (unsigned long long)file_bytes,
		                 (unsigned long long)header->file_bytes);
	if (header->count > ARCHIVE_COUNT_MAX || header->page_count > ARCHIVE_PAGES_MAX || header->depth > INDEX_DEPTH_MAX ||
	    (header->count == 0) != (header->page_count == 0) || (header->count == 0) != (header->depth == 0) ||
	    header->page_count < header->depth || header->count > (uint64_t)header->page_count * LEAF_ENTRIES_MAX)
		return error_set(error, BP_ERROR_CORRUPT, AT_COUNT, "%llu materials in %u index pages of %u levels cannot be",
		                 (unsigned long long)header->count, header->page_count, header->depth);
	if (header->index_offset < ARCHIVE_HEADER_BYTES || header->index_offset > file_bytes ||
	    file_bytes - header->index_offset != pages_bytes)
		return error_set(error, BP_ERROR_CORRUPT, AT_INDEX, "%u index pages at %llu do not end the file of %llu bytes",
		                 header->page_count, (unsigned long long)header->index_offset, (unsigned long long)file_bytes);
	return BP_OK;
}

bp_status archive_header_read(const uint8_t *bytes, size_t count, uint64_t file_bytes, struct archive_header *out,
                              bp_error *error)
{
	struct byte_reader in = byte_reader_over(bytes, count);
	struct archive_header header;

	if (count < ARCHIVE_MAGIC_BYTES || memcmp(bytes, ARCHIVE_MAGIC, ARCHIVE_MAGIC_BYTES) != 0)
		return error_set(error, BP_ERROR_NOT_OURS, 0, "not an archive: it does not begin as one");
	if (count < ARCHIVE_HEADER_BYTES)
		return error_set(error, BP_ERROR_CORRUPT, count, "the file ends after %zu bytes, within its header of %d", count,
		                 ARCHIVE_HEADER_BYTES);
	if (bytes_crc32(bytes, AT_CRC) != load_u32(bytes + AT_CRC))
		return error_set(error, BP_ERROR_CHECKSUM, AT_CRC, "the checksum of the archive's header differs");
	in.at = AT_MAJOR;
	const uint16_t major = read_u16(&in), minor = read_u16(&in);
	const uint32_t flags = read_u32(&in);
	header.file_bytes = read_u64(&in);
	header.count = read_u64(&in);
	header.index_offset = read_u64(&in);
	header.page_count = read_u32(&in);
	header.depth = read_u32(&in);
	const uint8_t *reserved = read_span(&in, AT_CRC - AT_RESERVED);
	if (major != ARCHIVE_MAJOR)
		return error_set(error, BP_ERROR_UNSUPPORTED, AT_MAJOR, "archive format %u.%u; this program reads %d.x", major, minor,
		                 ARCHIVE_MAJOR);
	if (flags & ARCHIVE_REQUIRED_FLAGS)
		return error_set(error, BP_ERROR_UNSUPPORTED, AT_FLAGS, "the archive needs features 0x%x that this program lacks",
		                 flags & ARCHIVE_REQUIRED_FLAGS);
	/* A newer minor version may use the reserved bytes; ours are zero. */
	for (int i = 0; minor <= ARCHIVE_MINOR && i < AT_CRC - AT_RESERVED; i++)
		if (reserved[i])
			return error_set(error, BP_ERROR_CORRUPT, (uint64_t)(AT_RESERVED + i), "reserved bytes of the header are not zero");
	const bp_status status = header_check(&header, file_bytes, error);
	if (!status)
		*out = header;
	return status;
}
