/* A record's head in the public header's words. */
#include <string.h>

#include "error.h"
#include "reader.h"

_Static_assert(BP_LAYERS_MAX == (int)LAYERS_MAX, "the public limit of layers");
_Static_assert(BP_SECTIONS_MAX == (int)RECORD_SECTIONS_MAX, "the public limit of sections");
_Static_assert(BP_NAME_BYTES_MAX == (int)RECORD_NAME_BYTES_MAX, "the public limit of names");

static void info_fill(const struct record_head *head, uint64_t offset, bp_material_info *info)
{
	memset(info, 0, sizeof *info);
	info->struct_bytes = sizeof *info;
	memcpy(info->name, head->name, sizeof info->name);
	info->profile = (uint32_t)head->profile;
	info->codec_version = head->codec_version;
	info->theta_h = head->dims.theta_h;
	info->theta_d = head->dims.theta_d;
	info->phi_d = head->dims.phi_d;
	info->head_bytes = head->head_bytes;
	info->record_bytes = head->record_bytes;
	info->record_offset = offset;
	for (int c = 0; c < 3; c++) {
		const struct colour_fit *fit = &head->colour[c];
		info->channels[c] = (bp_channel){fit->diffuse, fit->specular, fit->rejected, fit->iterations, fit->converged};
	}
	info->layer_count = head->layer_count;
	info->section_count = head->section_count;
	info->left_out = head->left_out;
	info->effort = (uint32_t)head->options.effort;
	info->budget_bytes = head->options.budget_bytes;
	info->max_error = head->options.max_error;
	info->source_bytes = head->source.bytes;
	memcpy(info->source_sha256, head->source.sha256, sizeof info->source_sha256);
	info->source_nonfinite = head->source.nonfinite_count;
	info->horizon_limit = head->horizon_limit;
	info->source_holes = head->source.hole_count;
	info->zeros = (uint32_t)head->options.zeros;
}

bp_status bp_archive_info(const bp_archive *archive, uint64_t index, bp_material_info *info, bp_error *error)
{
	struct index_entry entry;
	struct record_head head;
	if (!info || info->struct_bytes != sizeof *info)
		return error_argument(error, "struct_bytes is not set to sizeof(bp_material_info)");
	const bp_status status = archive_record_head(archive, index, &entry, &head, error);
	if (!status)
		info_fill(&head, entry.offset, info);
	return status;
}

/* The head, where the caller knows elements of `known` bytes as this library does. */
static bp_status elements_head(const bp_archive *archive, uint64_t index, size_t element_bytes, size_t known,
                               const void *elements, uint32_t capacity, struct record_head *head, bp_error *error)
{
	struct index_entry entry;
	if (element_bytes != known)
		return error_argument(error, "element_bytes is %zu, an element has %zu", element_bytes, known);
	if (capacity && !elements)
		return error_argument(error, "there is no place for %u elements", capacity);
	return archive_record_head(archive, index, &entry, head, error);
}

bp_status bp_archive_layers(const bp_archive *archive, uint64_t index, size_t element_bytes, bp_layer *layers, uint32_t capacity,
                            uint32_t *count, bp_error *error)
{
	struct record_head head;
	const bp_status status = elements_head(archive, index, element_bytes, sizeof *layers, layers, capacity, &head, error);
	if (status)
		return status;
	for (uint32_t l = 0; l < head.layer_count && l < capacity; l++) {
		const struct fidelity *figures = &head.layers[l].fidelity;
		layers[l] = (bp_layer){head.layers[l].bytes, figures->log_rmse, figures->cube_root_rmse, figures->largest_relative,
		                       figures->seen_log_rmse};
	}
	if (count)
		*count = head.layer_count;
	return BP_OK;
}

bp_status bp_archive_sections(const bp_archive *archive, uint64_t index, size_t element_bytes, bp_section *sections,
                              uint32_t capacity, uint32_t *count, bp_error *error)
{
	struct record_head head;
	const bp_status status = elements_head(archive, index, element_bytes, sizeof *sections, sections, capacity, &head, error);
	if (status)
		return status;
	for (uint32_t i = 0; i < head.section_count && i < capacity; i++) {
		const struct record_section *from = &head.sections[i];
		sections[i] = (bp_section){from->type, from->codec, from->version, from->layer, from->flags, from->bytes, from->error};
	}
	if (count)
		*count = head.section_count;
	return BP_OK;
}

bp_status bp_archive_record(const bp_archive *archive, uint64_t index, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	struct index_entry entry;
	struct record_head head;
	bp_status status = archive_entry(archive, index, NULL, &entry, error);
	if (!status)
		status = archive_entry_record(archive, &entry, &head, record, error);
	if (!status)
		*record_bytes = head.record_bytes;
	return status;
}
