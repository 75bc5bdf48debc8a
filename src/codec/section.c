#include "section.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
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
	uint64_t at;
	head->section_count = sections->count;
	head->head_bytes = record_head_size(strlen(head->name), head->layer_count, sections->count);
	if (head->head_bytes > RECORD_HEAD_BYTES_MAX)
		return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "the record's head would take %u bytes, the limit is %d",
		                 head->head_bytes, RECORD_HEAD_BYTES_MAX);
	at = head->head_bytes;
	for (uint32_t l = 0; l < head->layer_count; l++)
		head->layers[l].bytes = head->head_bytes;
	for (uint32_t i = 0; i < sections->count; i++) {
		struct record_section *entry = &head->sections[i];
		*entry = sections->entry[i];
		if (sections->bytes[i].failed)
			return error_memory(error, sections->bytes[i].count);
		if (entry->layer >= head->layer_count || (i && entry->layer < head->sections[i - 1].layer))
			return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "section %u has layer %u, out of order", i, entry->layer);
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

static void head_write_tables(const struct record_head *head, struct byte_buffer *out)
{
	for (uint32_t l = 0; l < head->layer_count; l++) {
		const struct record_layer *layer = &head->layers[l];
		write_u32(out, layer->bytes);
		write_f32(out, (float)fmin(layer->fidelity.seen_log_rmse, (double)FLT_MAX));
		write_f64(out, layer->fidelity.log_rmse);
		write_f64(out, layer->fidelity.cube_root_rmse);
		write_f64(out, layer->fidelity.largest_relative);
	}
	for (uint32_t i = 0; i < head->section_count; i++) {
		const struct record_section *entry = &head->sections[i];
		write_u16(out, entry->type);
		write_u16(out, entry->codec);
		write_u16(out, entry->version);
		write_u16(out, entry->layer);
		write_u16(out, entry->flags);
		write_u16(out, 0);
		write_u32(out, entry->offset);
		write_u32(out, entry->bytes);
		write_u32(out, entry->crc32);
		/* One bit pattern for "none", whatever NaN the processor made. */
		if (isnan(entry->error))
			write_u64(out, UINT64_C(0x7FF8000000000000));
		else
			write_f64(out, entry->error);
	}
}

static void head_write(const struct record_head *head, struct byte_buffer *out)
{
	size_t name_bytes = strlen(head->name);
	write_bytes(out, RECORD_MAGIC, RECORD_MAGIC_BYTES);
	write_u32(out, head->head_bytes);
	write_u32(out, head->record_bytes);
	write_u16(out, RECORD_VERSION);
	write_u16(out, (uint16_t)head->profile);
	write_u32(out, head->codec_version);
	write_u16(out, (uint16_t)head->dims.theta_h);
	write_u16(out, (uint16_t)head->dims.theta_d);
	write_u16(out, (uint16_t)head->dims.phi_d);
	write_u8(out, (uint8_t)name_bytes);
	write_u8(out, (uint8_t)head->layer_count);
	write_u16(out, (uint16_t)head->section_count);
	write_u16(out, (uint16_t)head->left_out);
	write_u32(out, head->options.budget_bytes);
	write_f64(out, head->options.max_error);
	write_u32(out, (uint32_t)head->options.effort);
	write_u32(out, head->source.hole_count | (uint32_t)head->options.zeros << HEAD_ZEROS_SHIFT);
	write_f64(out, head->horizon_limit);
	write_u64(out, head->source.bytes);
	write_bytes(out, head->source.sha256, SHA256_BYTES);
	write_u64(out, head->source.nonfinite_count);
	for (int c = 0; c < 3; c++) {
		write_f64(out, head->colour[c].diffuse);
		write_f64(out, head->colour[c].specular);
		write_f64(out, head->colour[c].rejected);
		write_u32(out, head->colour[c].iterations);
		write_u32(out, head->colour[c].converged);
	}
	head_write_tables(head, out);
	write_bytes(out, head->name, name_bytes);
	if (!out->failed)
		write_u32(out, bytes_crc32(out->bytes, out->count));
}

bp_status record_write(struct record_head *head, const struct section_list *sections, uint8_t **record, size_t *record_bytes,
                       bp_error *error)
{
	struct byte_buffer out = {0};
	const char *fault = name_fault(head->name, strlen(head->name));
	bp_status status;
	if (fault)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "\"%s\" is not a legal name: %s", head->name, fault);
	if (!lattice_dims_legal(head->dims) || head->layer_count < 1 || head->layer_count > LAYERS_MAX)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "a record of %ux%ux%u cells and %u layers cannot be written",
		                 head->dims.theta_h, head->dims.theta_d, head->dims.phi_d, head->layer_count);
	status = head_lay_out(head, sections, error);
	if (status)
		return status;
	head_write(head, &out);
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
