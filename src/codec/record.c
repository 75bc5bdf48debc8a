#include "record.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "profile_codec.h"
#include "record_origin.h"

uint32_t record_layers_for(const struct record_head *head, double max_log_rmse)
{
	for (uint32_t n = 0; max_log_rmse > 0 && n < head->layer_count; n++)
		if (head->layers[n].fidelity.seen_log_rmse <= max_log_rmse)
			return n + 1;
	return head->layer_count;
}

bp_status record_verify(const uint8_t *record, size_t count, struct record_head *head, bp_error *error)
{
	bp_status status = record_head_read(record, count, head, error);
	if (status)
		return status;
	if (head->record_bytes != count)
		return error_set(error, BP_ERROR_CORRUPT, 12, "the record has %u bytes, %zu were given", head->record_bytes, count);
	for (uint32_t i = 0; i < head->section_count; i++) {
		const struct record_section *entry = &head->sections[i];
		if (bytes_crc32(record + entry->offset, entry->bytes) != entry->crc32)
			return error_set(error, BP_ERROR_CHECKSUM, entry->offset, "the checksum of section %u differs", i);
	}
	return BP_OK;
}

bool record_answers(const struct record_head *head, const struct record_source *source, const struct fit_options *options)
{
	const struct profile_codec *codec = profile_codec_find(options->profile);
	return codec && head->codec_version == codec->version && head->profile == options->profile &&
	       head->options.budget_bytes == options->budget_bytes && head->options.max_error == options->max_error &&
	       head->options.effort == options->effort && head->options.zeros == options->zeros &&
	       head->source.hole_count == source->hole_count && record_origin_is_current(head) &&
	       head->source.bytes == source->bytes && !memcmp(head->source.sha256, source->sha256, SHA256_BYTES);
}

uint32_t record_bytes_needed(const struct record_head *head, uint32_t layers)
{
	const struct profile_codec *codec = profile_codec_find(head->profile);
	uint32_t bytes = head->head_bytes;
	for (uint32_t i = 0; codec && i < head->section_count && head->sections[i].layer < layers; i++)
		if (codec->reads(&head->sections[i]))
			bytes += head->sections[i].bytes;
	return bytes;
}

static bp_status section_fetch(const struct record_section *entry, record_fetch_fn *fetch, void *user, struct section_bytes *out,
                               bp_error *error)
{
	*out = (struct section_bytes){.entry = entry, .bytes = malloc(entry->bytes)};
	if (!out->bytes)
		return error_memory(error, entry->bytes);
	const bp_status status = fetch(user, entry->offset, out->bytes, entry->bytes, error);
	if (!status && bytes_crc32(out->bytes, entry->bytes) != entry->crc32)
		return error_set(error, BP_ERROR_CHECKSUM, entry->offset, "the checksum of a section of type %u differs", entry->type);
	return status;
}

/* Fetches what the layers need: *count sections, whose bytes the caller frees also after a failure. */
static bp_status sections_fetch(const struct record_head *head, const struct profile_codec *codec, uint32_t layers,
                                record_fetch_fn *fetch, void *user, struct section_bytes *sections, uint32_t *count,
                                bp_error *error)
{
	for (uint32_t i = 0; i < head->section_count && head->sections[i].layer < layers; i++) {
		const struct record_section *entry = &head->sections[i];
		if (codec->reads(entry)) {
			const bp_status status = section_fetch(entry, fetch, user, &sections[(*count)++], error);
			if (status)
				return status;
		} else if (codec->retired && codec->retired(entry)) {
			return error_set(
				error, BP_ERROR_UNSUPPORTED, entry->offset,
				"%s: packed by an earlier version whose records of this profile are no longer read; pack the material again",
				head->name);
		} else if (entry->flags & SECTION_REQUIRED) {
			return error_set(error, BP_ERROR_UNSUPPORTED, entry->offset,
			                 "%s: a section of type %u, codec %u, version %u is required; a newer program is needed", head->name,
			                 entry->type, entry->codec, entry->version);
		}
	}
	return BP_OK;
}

bp_status record_decode(const struct record_head *head, uint32_t layers, record_fetch_fn *fetch, void *user, struct model **out,
                        bp_error *error)
{
	const struct profile_codec *codec = profile_codec_find(head->profile);
	struct section_bytes sections[RECORD_SECTIONS_MAX];
	uint32_t count = 0, failed = UINT32_MAX;
	struct model *model;

	if (!codec)
		return error_set(error, BP_ERROR_UNSUPPORTED, 18, "%s: profile %u is not known; a newer program is needed", head->name,
		                 (unsigned)head->profile);
	if (layers == 0 || layers > head->layer_count)
		layers = head->layer_count;
	model = calloc(1, sizeof *model);
	if (!model)
		return error_memory(error, sizeof *model);
	model->profile = head->profile;
	model->dims = head->dims;
	model->horizon_limit = head->horizon_limit;
	memcpy(model->colour, head->colour, sizeof model->colour);
	model->layer_count = layers;
	bp_status status = sections_fetch(head, codec, layers, fetch, user, sections, &count, error);
	if (!status) {
		status = codec->decode(head, sections, count, model, &failed, error);
		status = error_shift(status, failed < count ? sections[failed].entry->offset : 0, error);
	}
	while (count > 0)
		free(sections[--count].bytes);
	if (status)
		model_free(model);
	else
		*out = model;
	return status;
}

static bp_status memory_fetch(void *user, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error)
{
	const uint8_t *record = user;
	(void)error;
	memcpy(bytes, record + offset, count);
	return BP_OK;
}

bp_status record_decode_whole(const struct record_head *head, uint32_t layers, const uint8_t *record, struct model **out,
                              bp_error *error)
{
	return record_decode(head, layers, memory_fetch, (void *)(uintptr_t)record, out, error);
}
