/* Records made from whole records: their sections byte for byte, under another head. */
#include <string.h>

#include "error.h"
#include "name.h"
#include "section.h"

/* Checks the record, and writes it with the layers 0..layers-1 and that name. */
static bp_status record_copy(const uint8_t *record, size_t count, uint32_t layers, const char *name, uint8_t **out,
                             size_t *out_bytes, bp_error *error)
{
	struct section_list kept = {0};
	struct record_head head;
	const bp_status status = record_verify(record, count, &head, error);
	if (status)
		return status;
	if (layers == 0 || layers > head.layer_count)
		layers = head.layer_count;
	for (uint32_t i = 0; i < head.section_count; i++) {
		const struct record_section *entry = &head.sections[i];
		if (entry->layer < layers)
			write_bytes(section_add(&kept, (enum section_type)entry->type, entry->codec, entry->version, entry->layer,
			                        entry->flags, entry->error),
			            record + entry->offset, entry->bytes);
	}
	if (layers < head.layer_count)
		head.codec_version = RECORD_LAYERS_DROPPED;
	head.layer_count = layers;
	if (name) {
		memset(head.name, 0, sizeof head.name);
		memcpy(head.name, name, strlen(name));
	}
	const bp_status written = sections_join(&head, &kept, out, out_bytes, error);
	section_list_free(&kept);
	return written;
}

bp_status record_keep_layers(const uint8_t *record, size_t count, uint32_t layers, uint8_t **out, size_t *out_bytes,
                             bp_error *error)
{
	return record_copy(record, count, layers, NULL, out, out_bytes, error);
}

bp_status record_rename(const uint8_t *record, size_t count, const char *name, uint8_t **out, size_t *out_bytes, bp_error *error)
{
	const char *fault = name_fault(name, strlen(name));
	if (fault)
		return error_argument(error, "\"%.255s\" is not a legal name: %s", name, fault);
	return record_copy(record, count, 0, name, out, out_bytes, error);
}
