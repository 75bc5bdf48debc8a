#include "merge.h"

#include <stdlib.h>
#include <string.h>

#include "codec/profile_codec.h"
#include "error.h"
#include "writer.h"

static uint32_t layers_wanted(const struct record_head *head, double max_log_rmse)
{
	for (uint32_t n = 0; max_log_rmse > 0 && n < head->layer_count; n++)
		if (head->layers[n].fidelity.log_rmse <= max_log_rmse)
			return n + 1;
	return head->layer_count;
}

static bp_status record_copy(const struct bp_archive *archive, const struct index_entry *entry, const struct copy_options *options,
                             struct archive_writer *writer, struct copy_totals *totals, bp_error *error)
{
	struct record_head head;
	uint8_t *record = NULL, *kept = NULL;
	totals->reading = true;
	bp_status status = archive_entry_record(archive, entry, &head, &record, error);
	if (status)
		return status;
	const uint32_t layers = layers_wanted(&head, options->max_log_rmse);
	size_t bytes = head.record_bytes;
	if (layers < head.layer_count)
		status = record_keep_layers(record, head.record_bytes, layers, &kept, &bytes, error);
	totals->reading = status != BP_OK;
	if (!status)
		status = archive_writer_add(writer, kept ? kept : record, bytes, error);
	if (!status) {
		totals->copied++;
		totals->trimmed += layers < head.layer_count;
		totals->bytes_from += head.record_bytes;
		totals->bytes_to += bytes;
	}
	free(kept);
	free(record);
	return status;
}

static bool stop_asked(const struct copy_options *options, struct copy_totals *totals)
{
	totals->stopped = options->stop && options->stop();
	return totals->stopped;
}

/* The end of both: commit, or leave no trace. */
static bp_status writer_end(struct archive_writer *writer, bp_status status, const struct copy_totals *totals, bp_error *error)
{
	if (!status && !totals->stopped)
		return archive_writer_commit(writer, error);
	archive_writer_discard(writer);
	return status;
}

bp_status archive_subset(const struct bp_archive *archive, const uint64_t *index, uint64_t count, const struct copy_options *options,
                         struct copy_totals *totals, bp_error *error)
{
	struct archive_writer *writer = NULL;
	struct index_page leaf;
	struct index_entry entry;

	*totals = (struct copy_totals){0};
	if (count == 0)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "no material to copy");
	bp_status status = archive_writer_open(options->output, &writer, error);
	if (status)
		return status;
	leaf.count = 0;
	for (uint64_t n = 0; n < count && !status && !stop_asked(options, totals); n++) {
		status = archive_entry(archive, index ? index[n] : n, &leaf, &entry, error);
		totals->reading = status != BP_OK;
		if (!status)
			status = record_copy(archive, &entry, options, writer, totals, error);
	}
	return writer_end(writer, status, totals, error);
}

/* One input's place in the walk through all names. */
struct input {
	const struct bp_archive *archive;
	uint64_t next, count; /* materials: entry is number next - 1, when it is `there` */
	struct index_page leaf;
	struct index_entry entry;
	bool there;
};

static bp_status input_advance(struct input *input, bp_error *error)
{
	input->there = input->next < input->count;
	return input->there ? archive_entry(input->archive, input->next++, &input->leaf, &input->entry, error) : BP_OK;
}

/* Copies the first name of all; where several have it, the last of them. */
static bp_status first_copy(struct input *inputs, size_t count, size_t chosen, const struct copy_options *options,
                            struct archive_writer *writer, struct copy_totals *totals, size_t *failed, bp_error *error)
{
	char name[RECORD_NAME_BYTES_MAX + 1];
	size_t last = chosen;
	bp_status status = BP_OK;

	strcpy(name, inputs[chosen].entry.name);
	for (size_t n = chosen + 1; n < count; n++) {
		if (!inputs[n].there || strcmp(inputs[n].entry.name, name) != 0)
			continue;
		if (!options->replace) {
			*failed = n;
			totals->reading = true;
			return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s: also in %s; with --replace the later one is taken", name,
			                 archive_path(inputs[last].archive));
		}
		totals->replaced++;
		last = n;
	}
	*failed = last;
	status = record_copy(inputs[last].archive, &inputs[last].entry, options, writer, totals, error);
	for (size_t n = chosen; n < count && !status; n++)
		if (inputs[n].there && !strcmp(inputs[n].entry.name, name)) {
			*failed = n;
			status = input_advance(&inputs[n], error);
			totals->reading = status != BP_OK;
		}
	return status;
}

bp_status archive_merge(const struct bp_archive *const *archives, size_t count, const struct copy_options *options,
                        struct copy_totals *totals, size_t *failed, bp_error *error)
{
	struct archive_writer *writer = NULL;
	struct input *inputs = calloc(count ? count : 1, sizeof *inputs);
	bp_status status = BP_OK;

	*totals = (struct copy_totals){0};
	*failed = 0;
	if (!inputs)
		return error_memory(error, count * sizeof *inputs);
	for (size_t n = 0; n < count && !status; n++) {
		inputs[n].archive = archives[n];
		inputs[n].count = bp_archive_count(archives[n]);
		*failed = n;
		status = input_advance(&inputs[n], error);
		totals->reading = status != BP_OK;
	}
	if (!status)
		status = archive_writer_open(options->output, &writer, error);
	while (!status && !stop_asked(options, totals)) {
		size_t first = count;
		for (size_t n = 0; n < count; n++)
			if (inputs[n].there && (first == count || strcmp(inputs[n].entry.name, inputs[first].entry.name) < 0))
				first = n;
		if (first == count)
			break;
		status = first_copy(inputs, count, first, options, writer, totals, failed, error);
	}
	if (writer)
		status = writer_end(writer, status, totals, error);
	free(inputs);
	return status;
}

bp_status archive_reuse(const struct bp_archive *archive, const char *name, const struct record_source *source,
                        const struct fit_options *options, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	const struct profile_codec *codec = profile_codec_find(options->profile);
	struct index_page leaf;
	struct index_entry entry;
	struct record_head head;
	uint64_t index;

	*record = NULL;
	leaf.count = 0;
	bp_status status = bp_archive_find(archive, name, &index, error);
	if (!status)
		status = archive_entry(archive, index, &leaf, &entry, error);
	if (!status)
		status = archive_entry_head(archive, &entry, &head, error);
	if (status == BP_ERROR_MEMORY || status == BP_ERROR_IO)
		return status;
	bool same = !status && codec && head.codec_version == codec->version && head.profile == options->profile &&
	            head.options.budget_bytes == options->budget_bytes && head.options.max_error == options->max_error &&
	            head.options.effort == options->effort && head.source.bytes == source->bytes &&
	            !memcmp(head.source.sha256, source->sha256, SHA256_BYTES);
	if (!same)
		return BP_OK;
	status = archive_entry_record(archive, &entry, &head, record, error);
	*record_bytes = head.record_bytes;
	return status == BP_ERROR_MEMORY || status == BP_ERROR_IO ? status : BP_OK;
}
