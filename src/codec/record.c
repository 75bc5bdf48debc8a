#include "record.h"

#include <math.h>
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "../model/fidelity.h"
#include "profile_codec.h"

/* ---- decoding ---- */

static bool kind_known(const struct profile_codec *codec, const struct record_section *entry)
{
	for (uint32_t i = 0; i < codec->kind_count; i++)
		if (codec->kinds[i].type == entry->type && codec->kinds[i].codec == entry->codec && codec->kinds[i].version == entry->version)
			return true;
	return false;
}

static bp_status section_fetch(const struct record_section *entry, record_fetch_fn *fetch, void *user, uint8_t **out,
                               bp_error *error)
{
	uint8_t *bytes = malloc(entry->bytes);
	bp_status status;
	if (!bytes)
		return error_memory(error, entry->bytes);
	status = fetch(user, entry->offset, bytes, entry->bytes, error);
	if (!status && bytes_crc32(bytes, entry->bytes) != entry->crc32)
		status = error_set(error, BP_ERROR_CHECKSUM, entry->offset, "the checksum of a section of type %u differs", entry->type);
	if (status) {
		free(bytes);
		return status;
	}
	*out = bytes;
	return BP_OK;
}

/* Fetches what the layers need: *count sections, whose bytes the caller frees also after a failure. */
static bp_status sections_fetch(const struct record_head *head, const struct profile_codec *codec, uint32_t layers,
                                record_fetch_fn *fetch, void *user, struct section_bytes *sections, uint8_t **held,
                                uint32_t *count, bp_error *error)
{
	for (uint32_t i = 0; i < head->section_count && head->sections[i].layer < layers; i++) {
		const struct record_section *entry = &head->sections[i];
		bp_status status;
		if (!kind_known(codec, entry)) {
			if (entry->flags & SECTION_REQUIRED)
				return error_set(error, BP_ERROR_UNSUPPORTED, entry->offset,
				                 "%s: a section of type %u, codec %u, version %u is required; a newer program is needed", head->name,
				                 entry->type, entry->codec, entry->version);
			continue;
		}
		status = section_fetch(entry, fetch, user, &held[*count], error);
		if (status)
			return status;
		sections[*count] = (struct section_bytes){ .entry = entry, .bytes = held[*count] };
		++*count;
	}
	return BP_OK;
}

bp_status record_decode(const struct record_head *head, uint32_t layers, record_fetch_fn *fetch, void *user,
                        struct model **out, bp_error *error)
{
	const struct profile_codec *codec = profile_codec_find(head->profile);
	struct section_bytes sections[RECORD_SECTIONS_MAX];
	uint8_t *held[RECORD_SECTIONS_MAX];
	uint32_t count = 0, failed = UINT32_MAX;
	struct model *model;
	bp_status status;

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
	status = sections_fetch(head, codec, layers, fetch, user, sections, held, &count, error);
	if (!status) {
		status = codec->decode(head, sections, count, model, &failed, error);
		if (status && failed < count && error && error->offset != BP_NO_OFFSET)
			error->offset += sections[failed].entry->offset;
	}
	while (count > 0)
		free(held[--count]);
	if (status)
		model_free(model);
	else
		*out = model;
	return status;
}

/* ---- packing ---- */

static bp_status memory_fetch(void *user, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error)
{
	const uint8_t *record = user;
	(void)error;
	memcpy(bytes, record + offset, count);
	return BP_OK;
}

/* Figures are stored finite: a relative error beyond the range of a double is the largest double. */
static double figure_stored(double figure)
{
	return figure < DBL_MAX ? figure : DBL_MAX;
}

/* Decodes every layer from the record's own bytes and measures it. */
static bp_status layers_measure(struct record_head *head, const uint8_t *record, const struct lattice *lattice, bp_error *error)
{
	struct expansion table = { 0 };
	bp_status status = expansion_alloc(head->dims, &table, error);
	for (uint32_t l = 0; !status && l < head->layer_count; l++) {
		struct fidelity *figures = &head->layers[l].fidelity;
		struct model *model = NULL;
		status = record_decode(head, l + 1, memory_fetch, (void *)(uintptr_t)record, &model, error);
		if (!status)
			status = model_expand(model, 0, &table, error);
		if (!status)
			status = fidelity_measure(lattice, &table, figures, error);
		figures->log_rmse = figure_stored(figures->log_rmse);
		figures->cube_root_rmse = figure_stored(figures->cube_root_rmse);
		figures->largest_relative = figure_stored(figures->largest_relative);
		model_free(model);
	}
	expansion_free(&table);
	return status;
}

static void head_fill(struct record_head *head, const struct model *model, const char *name, const struct record_source *source,
                      const struct fit_options *options, uint32_t codec_version)
{
	memset(head, 0, sizeof *head);
	memcpy(head->name, name, strlen(name));
	head->profile = model->profile;
	head->codec_version = codec_version;
	head->dims = model->dims;
	head->horizon_limit = model->horizon_limit;
	memcpy(head->colour, model->colour, sizeof head->colour);
	head->options = *options;
	head->source = *source;
}

bp_status record_pack(const struct lattice *lattice, const char *name, const struct record_source *source,
                      const struct fit_options *options, uint8_t **out_record, size_t *out_bytes, struct record_head *out_head,
                      bp_error *error)
{
	const struct profile_codec *codec = profile_codec_find(options->profile);
	struct encode_request request = { .options = options, .record_bytes_max = options->budget_bytes };
	struct section_list sections = { 0 };
	struct record_head head;
	struct model *model = NULL;
	uint8_t *record = NULL;
	size_t record_bytes = 0;
	bp_status status;

	request.name_bytes = strlen(name);
	if (!codec || request.name_bytes > RECORD_NAME_BYTES_MAX)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, codec ? "the name is longer than 255 bytes" : "no such profile");
	status = model_fit(lattice, options, &model, error);
	if (status)
		return status;
	head_fill(&head, model, name, source, options, codec->version);
	status = codec->encode(model, &request, &sections, &head.layer_count, &head.left_out, error);
	if (status)
		goto out;
	/* Once to have the bytes that are decoded, once more with what was measured on them. */
	status = record_write(&head, &sections, &record, &record_bytes, error);
	if (status)
		goto out;
	status = layers_measure(&head, record, lattice, error);
	free(record);
	record = NULL;
	if (!status)
		status = record_write(&head, &sections, &record, &record_bytes, error);
	if (!status && head.record_bytes > request.record_bytes_max)
		status = error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "the record takes %u bytes, the budget is %u", head.record_bytes,
		                   request.record_bytes_max);
	if (!status && out_head)
		status = record_head_parse(record, record_bytes, out_head, error);
	if (status) {
		free(record);
		goto out;
	}
	*out_record = record;
	*out_bytes = record_bytes;
out:
	section_list_free(&sections);
	model_free(model);
	return status;
}
