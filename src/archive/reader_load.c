/* The rest of the reader: what needs a decoder. */
#include "error.h"
#include "reader.h"

struct fetch_place {
	const struct bp_archive *archive;
	uint64_t offset; /* of the record */
};

static bp_status record_fetch(void *user, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error)
{
	const struct fetch_place *place = user;
	/* record_decode speaks of offsets from the record's start, and so do we to it. */
	return error_shift(archive_read(place->archive, place->offset + offset, bytes, count, error), -place->offset, error);
}

bp_status archive_entry_load(const struct bp_archive *archive, const struct index_entry *entry, const struct record_head *head,
                             uint32_t layers, struct model **out, bp_error *error)
{
	struct fetch_place place = {.archive = archive, .offset = entry->offset};
	return error_shift(record_decode(head, layers, record_fetch, &place, out, error), entry->offset, error);
}

bp_status archive_model_load(const struct bp_archive *archive, uint64_t index, uint32_t layers, struct model **out,
                             bp_error *error)
{
	struct index_entry entry;
	struct record_head head;
	const bp_status status = archive_record_head(archive, index, &entry, &head, error);
	return status ? status : archive_entry_load(archive, &entry, &head, layers, out, error);
}
