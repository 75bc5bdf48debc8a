/* What is known of the file behind a record beyond its head. */
#include "bytes.h"
#include "codec/record_origin.h"
#include "error.h"
#include "reader.h"

bp_status archive_entry_origin(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                               struct origin *out, bp_error *error)
{
	const struct record_section *section = record_origin_find(head);
	uint8_t bytes[ORIGIN_BYTES];
	*out = (struct origin){.kind = ORIGIN_MERL};
	if (!section)
		return BP_OK;
	const uint64_t at = entry->offset + section->offset;
	bp_status status = archive_read(archive, at, bytes, sizeof bytes, error);
	if (!status && bytes_crc32(bytes, sizeof bytes) != section->crc32)
		status = error_set(error, BP_ERROR_CHECKSUM, at, "the checksum of a section of type %u differs", section->type);
	return status ? status : error_shift(record_origin_parse(bytes, out, error), at, error);
}
