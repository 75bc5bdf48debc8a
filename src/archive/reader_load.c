/* The rest of the reader: what needs a decoder. */
#include "reader.h"

struct fetch_place {
	const struct bp_archive *archive;
	uint64_t offset; /* of the record */
};

static bp_status record_fetch(void *user, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error)
{
	const struct fetch_place *place = user;
	bp_status status = archive_read(place->archive, place->offset + offset, bytes, count, error);
	/* record_decode speaks of offsets from the record's start, and so do we to it. */
	if (status && error && error->offset != BP_NO_OFFSET)
		error->offset -= place->offset;
	return status;
}

bp_status archive_entry_load(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                             uint32_t layers, struct model **out, bp_error *error)
{
	struct fetch_place place = {.archive = archive, .offset = entry->offset};
	bp_status status = record_decode(head, layers, record_fetch, &place, out, error);
	if (status && error && error->offset != BP_NO_OFFSET)
		error->offset += entry->offset;
	return status;
}

bp_status archive_model_load(const struct bp_archive *archive, uint64_t index, uint32_t layers, struct model **out,
                             bp_error *error)
{
	struct index_page leaf;
	struct index_entry entry;
	struct record_head head;
	bp_status status;
	leaf.count = 0;
	status = archive_entry(archive, index, &leaf, &entry, error);
	if (!status)
		status = archive_entry_head(archive, &entry, &head, error);
	return status ? status : archive_entry_load(archive, &entry, &head, layers, out, error);
}
