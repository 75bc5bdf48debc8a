#include "section.h"

#include <string.h>

#include "error.h"
#include "name.h"

struct byte_buffer *section_add(struct section_list *list, enum section_type type, uint16_t codec, uint16_t version,
                                uint32_t layer, uint32_t flags, double error)
{
	if (list->count == RECORD_SECTIONS_MAX || layer >= LAYERS_MAX)
		return NULL;
	list->entry[list->count] = (struct record_section){
		.type = (uint16_t)type,
		.codec = codec,
		.version = version,
		.layer = (uint16_t)layer,
		.flags = (uint16_t)flags,
		.error = error,
	};
	return &list->bytes[list->count++];
}

void section_list_free(struct section_list *list)
{
	for (uint32_t i = 0; i < list->count; i++)
		byte_buffer_free(&list->bytes[i]);
	*list = (struct section_list){0};
}

/* Places the sections behind the head and measures the layers. */
static bp_status head_lay_out(struct record_head *head, const struct section_list *sections, bp_error *error)
{
	head->section_count = sections->count;
	head->head_bytes = record_head_size(strlen(head->name), head->layer_count, sections->count);
	if (head->head_bytes > RECORD_HEAD_BYTES_MAX)
		return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "the record's head would take %u bytes, the limit is %d",
		                 head->head_bytes, RECORD_HEAD_BYTES_MAX);
	uint64_t at = head->head_bytes;
	for (uint32_t l = 0; l < head->layer_count; l++)
		head->layers[l].bytes = head->head_bytes;
	for (uint32_t i = 0; i < sections->count; i++) {
		struct record_section *entry = &head->sections[i];
		*entry = sections->entry[i];
		if (sections->bytes[i].failed)
			return error_memory(error, sections->bytes[i].count);
		if (entry->layer >= head->layer_count || (i && entry->layer < head->sections[i - 1].layer))
			return error_argument(error, "section %u has layer %u, out of order", i, entry->layer);
		if (sections->bytes[i].count == 0 || sections->bytes[i].count > RECORD_BYTES_MAX - at)
			return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "section %u has %zu bytes; a record has at most %d", i,
			                 sections->bytes[i].count, RECORD_BYTES_MAX);
		entry->offset = (uint32_t)at;
		entry->bytes = (uint32_t)sections->bytes[i].count;
		entry->crc32 = bytes_crc32(sections->bytes[i].bytes, entry->bytes);
		at += entry->bytes;
		for (uint32_t l = entry->layer; l < head->layer_count; l++)
			head->layers[l].bytes = (uint32_t)at;
	}
	head->record_bytes = (uint32_t)at;
	return BP_OK;
}

bp_status sections_join(struct record_head *head, const struct section_list *sections, uint8_t **record, size_t *record_bytes,
                        bp_error *error)
{
	struct byte_buffer out = {0};
	const char *fault = name_fault(head->name, strlen(head->name));
	if (fault)
		return error_argument(error, "\"%s\" is not a legal name: %s", head->name, fault);
	if (!lattice_dims_legal(head->dims) || head->layer_count < 1 || head->layer_count > LAYERS_MAX)
		return error_argument(error, "a record of %ux%ux%u cells and %u layers cannot be written", head->dims.theta_h,
		                      head->dims.theta_d, head->dims.phi_d, head->layer_count);
	bp_status status = head_lay_out(head, sections, error);
	if (status)
		return status;
	record_head_write(head, &out);
	for (uint32_t i = 0; i < sections->count; i++)
		write_bytes(&out, sections->bytes[i].bytes, sections->bytes[i].count);
	if (out.failed) {
		byte_buffer_free(&out);
		return error_memory(error, head->record_bytes);
	}
	*record = out.bytes;
	*record_bytes = out.count;
	return BP_OK;
}
