#include <math.h>
#include <string.h>

#include "bytes.h"
#include "error.h"
#include "name.h"
#include "record.h"

uint32_t record_head_size(size_t name_bytes, uint32_t layer_count, uint32_t section_count)
{
	return (uint32_t)(208 + 32 * (layer_count + section_count) + name_bytes + 4);
}

/* Where things stand in a head, for error offsets. */
enum {
	AT_HEAD_BYTES = 8,
	AT_RECORD_BYTES = 12,
	AT_VERSION = 16,
	AT_DIMS = 24,
	AT_LAYER_COUNT = 31,
	AT_SECTION_COUNT = 32,
	AT_OPTIONS = 36,
	AT_HOLES = 52,
	AT_HORIZON = 56,
	AT_COLOUR = 112,
	AT_TABLES = 208
};

bp_status record_probe(const uint8_t bytes[RECORD_PROBE_BYTES], uint32_t *head_bytes, uint32_t *record_bytes, bp_error *error)
{
	uint32_t head = load_u32(bytes + AT_HEAD_BYTES), record = load_u32(bytes + AT_RECORD_BYTES);
	if (memcmp(bytes, RECORD_MAGIC, RECORD_MAGIC_BYTES) != 0)
		return error_set(error, BP_ERROR_CORRUPT, 0, "a record should begin here");
	if (head < RECORD_HEAD_BYTES_MIN || head > RECORD_HEAD_BYTES_MAX)
		return error_set(error, BP_ERROR_CORRUPT, AT_HEAD_BYTES, "the record's head claims %u bytes; %d to %d are possible", head,
		                 RECORD_HEAD_BYTES_MIN, RECORD_HEAD_BYTES_MAX);
	if (record < head || record > RECORD_BYTES_MAX)
		return error_set(error, BP_ERROR_CORRUPT, AT_RECORD_BYTES, "the record claims %u bytes; %u to %d are possible", record,
		                 head, RECORD_BYTES_MAX);
	*head_bytes = head;
	*record_bytes = record;
	return BP_OK;
}

/* A figure of a layer: not negative, not NaN. */
static bool figure_legal(double figure) { return figure >= 0; }

static bp_status layers_read(struct byte_reader *in, struct record_head *head, bp_error *error)
{
	for (uint32_t l = 0; l < head->layer_count; l++) {
		struct record_layer *layer = &head->layers[l];
		uint64_t at = in->at;
		layer->bytes = read_u32(in);
		layer->fidelity.seen_log_rmse = (double)read_f32(in);
		layer->fidelity.log_rmse = read_f64(in);
		layer->fidelity.cube_root_rmse = read_f64(in);
		layer->fidelity.largest_relative = read_f64(in);
		if (!figure_legal(layer->fidelity.seen_log_rmse) || !figure_legal(layer->fidelity.log_rmse) ||
		    !figure_legal(layer->fidelity.cube_root_rmse) || !figure_legal(layer->fidelity.largest_relative))
			return error_set(error, BP_ERROR_CORRUPT, at, "layer %u: a figure is negative or not a number", l);
	}
	return BP_OK;
}

/* Sections fill the record behind the head without gap or overlap, in the order of their layers. */
static bp_status sections_read(struct byte_reader *in, struct record_head *head, bp_error *error)
{
	uint64_t end = head->head_bytes;
	for (uint32_t i = 0; i < head->section_count; i++) {
		struct record_section *entry = &head->sections[i];
		uint64_t at = in->at;
		entry->type = read_u16(in);
		entry->codec = read_u16(in);
		entry->version = read_u16(in);
		entry->layer = read_u16(in);
		entry->flags = read_u16(in);
		uint16_t zero = read_u16(in);
		entry->offset = read_u32(in);
		entry->bytes = read_u32(in);
		entry->crc32 = read_u32(in);
		entry->error = read_f64(in);
		if (zero)
			return error_set(error, BP_ERROR_CORRUPT, at + 10, "section %u: reserved bytes are not zero", i);
		if (entry->layer >= head->layer_count || (i && entry->layer < head->sections[i - 1].layer))
			return error_set(error, BP_ERROR_CORRUPT, at + 6, "section %u: layer %u is out of order", i, entry->layer);
		if (entry->offset != end || entry->bytes == 0 || entry->bytes > head->record_bytes - end)
			return error_set(error, BP_ERROR_CORRUPT, at + 12,
			                 "section %u: %u bytes at %u do not follow on byte %llu of a record of %u", i, entry->bytes,
			                 entry->offset, (unsigned long long)end, head->record_bytes);
		end += entry->bytes;
	}
	if (end != head->record_bytes)
		return error_set(error, BP_ERROR_CORRUPT, AT_RECORD_BYTES, "the record has %u bytes, its sections end at %llu",
		                 head->record_bytes, (unsigned long long)end);
	return BP_OK;
}

/* A layer ends where its last section, or the last one of a layer below, ends. */
static bp_status layers_check(const struct record_head *head, bp_error *error)
{
	uint32_t section = 0, end = head->head_bytes;
	for (uint32_t l = 0; l < head->layer_count; l++) {
		for (; section < head->section_count && head->sections[section].layer == l; section++)
			end = head->sections[section].offset + head->sections[section].bytes;
		if (head->layers[l].bytes != end)
			return error_set(error, BP_ERROR_CORRUPT, AT_TABLES + 32 * l, "layer %u claims %u bytes, its sections end at %u", l,
			                 head->layers[l].bytes, end);
	}
	return BP_OK;
}

static bp_status colour_read(struct byte_reader *in, struct record_head *head, bp_error *error)
{
	for (uint32_t c = 0; c < 3; c++) {
		struct colour_fit *fit = &head->colour[c];
		fit->diffuse = read_f64(in);
		fit->specular = read_f64(in);
		fit->rejected = read_f64(in);
		fit->iterations = read_u32(in);
		fit->converged = read_u32(in);
		if (!isfinite(fit->diffuse) || !isfinite(fit->specular) || !(fit->rejected >= 0 && fit->rejected <= 1) ||
		    fit->converged > 1)
			return error_set(error, BP_ERROR_CORRUPT, AT_COLOUR + 32 * c, "channel %u: colour parameters out of range", c);
	}
	return BP_OK;
}

/* The fixed part behind the two sizes, up to the colours. */
static bp_status fixed_read(struct byte_reader *in, struct record_head *head, size_t *name_bytes, bp_error *error)
{
	uint32_t version, effort, holes;
	in->at = AT_VERSION;
	version = read_u16(in);
	if (version != RECORD_VERSION)
		return error_set(error, BP_ERROR_UNSUPPORTED, AT_VERSION, "record version %u; this program reads version %d", version,
		                 RECORD_VERSION);
	head->profile = (enum profile)read_u16(in);
	head->codec_version = read_u32(in);
	head->dims.theta_h = read_u16(in);
	head->dims.theta_d = read_u16(in);
	head->dims.phi_d = read_u16(in);
	*name_bytes = read_u8(in);
	head->layer_count = read_u8(in);
	head->section_count = read_u16(in);
	head->left_out = read_u16(in);
	head->options.profile = head->profile;
	head->options.budget_bytes = read_u32(in);
	head->options.max_error = read_f64(in);
	effort = read_u32(in);
	head->options.effort = (int)(effort & 0xFF);
	holes = read_u32(in);
	head->options.zeros = (enum zeros_rule)(holes >> HEAD_ZEROS_SHIFT);
	head->source.hole_count = holes & ((1u << HEAD_ZEROS_SHIFT) - 1);
	head->horizon_limit = read_f64(in);
	head->source.bytes = read_u64(in);
	read_bytes(in, head->source.sha256, SHA256_BYTES);
	head->source.nonfinite_count = read_u64(in);
	if (!lattice_dims_legal(head->dims))
		return error_set(error, BP_ERROR_CORRUPT, AT_DIMS, "a lattice of %ux%ux%u cells is beyond the limits", head->dims.theta_h,
		                 head->dims.theta_d, head->dims.phi_d);
	if (head->layer_count < 1 || head->layer_count > LAYERS_MAX)
		return error_set(error, BP_ERROR_CORRUPT, AT_LAYER_COUNT, "%u layers; 1 to %d are possible", head->layer_count,
		                 LAYERS_MAX);
	if (head->section_count > RECORD_SECTIONS_MAX)
		return error_set(error, BP_ERROR_CORRUPT, AT_SECTION_COUNT, "%u sections; at most %d are possible", head->section_count,
		                 RECORD_SECTIONS_MAX);
	if (record_head_size(*name_bytes, head->layer_count, head->section_count) != head->head_bytes)
		return error_set(error, BP_ERROR_CORRUPT, AT_HEAD_BYTES,
		                 "a head of %u bytes does not fit %zu bytes of name, %u layers and %u sections", head->head_bytes,
		                 *name_bytes, head->layer_count, head->section_count);
	if (!(head->options.max_error >= 0) || !isfinite(head->options.max_error) || effort > 9)
		return error_set(error, BP_ERROR_CORRUPT, AT_OPTIONS, "options out of range");
	if (head->options.zeros > ZEROS_MEASURED ||
	    head->source.hole_count > (head->options.zeros == ZEROS_MEASURED ? 0 : lattice_cells(head->dims)))
		return error_set(error, BP_ERROR_CORRUPT, AT_HOLES, "%u cells taken as holes by rule %u are not possible",
		                 head->source.hole_count, (unsigned)head->options.zeros);
	if (!(head->horizon_limit >= -1 && head->horizon_limit <= 0))
		return error_set(error, BP_ERROR_CORRUPT, AT_HORIZON, "a horizon at cosine %g; -1 to 0 are possible",
		                 head->horizon_limit);
	return BP_OK;
}

bp_status record_head_read(const uint8_t *bytes, size_t count, struct record_head *out, bp_error *error)
{
	struct record_head head;
	struct byte_reader in;
	size_t name_bytes = 0;

	memset(&head, 0, sizeof head);
	head.channels = 7;
	if (count < RECORD_PROBE_BYTES)
		return error_set(error, BP_ERROR_CORRUPT, count, "the record ends after %zu bytes", count);
	bp_status status = record_probe(bytes, &head.head_bytes, &head.record_bytes, error);
	if (status)
		return status;
	if (head.head_bytes > count)
		return error_set(error, BP_ERROR_CORRUPT, count, "the record's head has %u bytes, only %zu are there", head.head_bytes,
		                 count);
	if (bytes_crc32(bytes, head.head_bytes - 4) != load_u32(bytes + head.head_bytes - 4))
		return error_set(error, BP_ERROR_CHECKSUM, head.head_bytes - 4, "the checksum of the record's head differs");
	in = byte_reader_over(bytes, head.head_bytes - 4);
	status = fixed_read(&in, &head, &name_bytes, error);
	if (!status)
		status = colour_read(&in, &head, error);
	if (!status)
		status = layers_read(&in, &head, error);
	if (!status)
		status = sections_read(&in, &head, error);
	if (!status)
		status = layers_check(&head, error);
	if (status)
		return status;
	read_bytes(&in, head.name, name_bytes);
	const char *fault = name_fault(head.name, name_bytes);
	if (in.failed || fault)
		return error_set(error, BP_ERROR_CORRUPT, in.at - name_bytes, "the record's name is not legal: %s",
		                 fault ? fault : "short");
	*out = head;
	return BP_OK;
}
