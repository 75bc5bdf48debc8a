#include "merge.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "name.h"
#include "writer.h"

/* The first record seen, with which those of all shards of one build have profile, version and options in common. */
struct likeness {
	const struct bp_archive *archive; /* NULL: none has been seen */
	struct record_head head;
};

static bp_status likeness_check(struct likeness *first, const struct bp_archive *archive, const struct record_head *head,
                                bp_error *error)
{
	if (!first->archive) {
		*first = (struct likeness){archive, *head};
		return BP_OK;
	}
	const struct fit_options *now = &head->options, *then = &first->head.options;
	const char *what = head->profile != first->head.profile               ? "profile"
	                   : head->codec_version != first->head.codec_version ? "codec version"
	                   : now->budget_bytes != then->budget_bytes          ? "budget"
	                   : now->max_error != then->max_error                ? "bound of the error"
	                   : now->effort != then->effort                      ? "effort"
	                   : now->zeros != then->zeros                        ? "rule for zeros"
	                                                                      : NULL;
	return !what ? BP_OK
	             : error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
	                         "%s: made with another %s than %s in %s: these are not shards of one build; build "
	                         "them with the same program and options",
	                         head->name, what, first->head.name, archive_path(first->archive));
}

static bp_status record_copy(const struct bp_archive *archive, const struct index_entry *entry,
                             const struct copy_options *options, struct likeness *likeness, struct archive_writer *writer,
                             struct copy_totals *totals, bp_error *error)
{
	struct record_head head;
	uint8_t *record = NULL, *kept = NULL;
	totals->reading = true;
	bp_status status = archive_entry_record(archive, entry, &head, &record, error);
	if (status)
		strcpy(totals->damaged, entry->name);
	if (!status && options->shards)
		status = likeness_check(likeness, archive, &head, error);
	if (status)
		goto out;
	const uint32_t layers = record_layers_for(&head, options->max_log_rmse);
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
out:
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

bp_status archive_subset(const struct bp_archive *archive, const uint64_t *index, uint64_t count,
                         const struct copy_options *options, struct copy_totals *totals, bp_error *error)
{
	struct archive_writer *writer = NULL;
	struct index_page leaf;
	struct index_entry entry;

	*totals = (struct copy_totals){0};
	if (count == 0)
		return error_argument(error, "no material to copy");
	bp_status status = archive_writer_open(options->output, &writer, error);
	if (status)
		return status;
	leaf.count = 0;
	for (uint64_t n = 0; n < count && !status && !stop_asked(options, totals); n++) {
		status = archive_entry(archive, index ? index[n] : n, &leaf, &entry, error);
		totals->reading = status != BP_OK;
		if (!status)
			status = record_copy(archive, &entry, options, NULL, writer, totals, error);
	}
	return writer_end(writer, status, totals, error);
}

/* One input's place in the walk through all names. */
struct input {
	const struct bp_archive *archive;
	size_t number;
	uint32_t shard;       /* of a build into copy_options.shards, by the names seen; 0: none seen */
	uint64_t next, count; /* materials: entry is number next - 1 */
	struct index_page leaf;
	struct index_entry entry;
};

/* The inputs that have a name left, as a heap: the first name at the top; of the same names, the first input's. */
struct walk {
	struct input **heap;
	size_t count;
	uint32_t shards;           /* as in copy_options */
	const struct input **seen; /* [shards]: the input that is shard n + 1, or NULL */
	struct likeness likeness;
};

/* Is the name that the input has come to one of its shard, and is no other input that shard? */
static bp_status shard_check(const struct walk *walk, struct input *input, bp_error *error)
{
	const char *const name = input->entry.name;
	if (!walk->shards)
		return BP_OK;
	const uint32_t shard = name_shard(name, walk->shards);
	if (!input->shard) {
		const struct input *const same = walk->seen[shard - 1];
		if (same)
			return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
			                 "%s: belongs to shard %u/%u, as do the materials of %s: give each shard once", name, shard,
			                 walk->shards, archive_path(same->archive));
		walk->seen[shard - 1] = input;
		input->shard = shard;
	}
	if (input->shard != shard)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
		                 "%s: belongs to shard %u/%u, others in it to %u/%u: not made with --shard K/%u", name, shard,
		                 walk->shards, input->shard, walk->shards, walk->shards);
	return BP_OK;
}

/* The input comes to its next name; there is one. */
static bp_status input_advance(struct input *input, const struct walk *walk, bp_error *error)
{
	const bp_status status = archive_entry(input->archive, input->next++, &input->leaf, &input->entry, error);
	return status ? status : shard_check(walk, input, error);
}

static bool input_before(const struct input *a, const struct input *b)
{
	const int order = strcmp(a->entry.name, b->entry.name);
	return order < 0 || (order == 0 && a->number < b->number);
}

static void walk_sink(struct walk *walk, size_t at)
{
	for (;;) {
		size_t first = at;
		for (size_t child = 2 * at + 1; child <= 2 * at + 2 && child < walk->count; child++)
			if (input_before(walk->heap[child], walk->heap[first]))
				first = child;
		if (first == at)
			return;
		struct input *const swap = walk->heap[at];
		walk->heap[at] = walk->heap[first];
		walk->heap[first] = swap;
		at = first;
	}
}

/* The input at the top goes on to its next name, or leaves the heap. */
static bp_status walk_advance(struct walk *walk, bp_error *error)
{
	struct input *input = walk->heap[0];
	bp_status status = BP_OK;
	if (input->next == input->count)
		walk->heap[0] = walk->heap[--walk->count];
	else
		status = input_advance(input, walk, error);
	if (!status)
		walk_sink(walk, 0);
	return status;
}

/* Copies the first name of all; where several have it, the last of them. */
static bp_status first_copy(struct walk *walk, const struct copy_options *options, struct archive_writer *writer,
                            struct copy_totals *totals, size_t *failed, bp_error *error)
{
	struct index_entry entry = walk->heap[0]->entry;
	const struct input *last = walk->heap[0];

	*failed = last->number;
	totals->reading = true;
	bp_status status = walk_advance(walk, error);
	while (!status && walk->count && !strcmp(walk->heap[0]->entry.name, entry.name)) {
		const struct bp_archive *const before = last->archive;
		last = walk->heap[0];
		*failed = last->number;
		if (!options->replace)
			return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s: also in %s; with --replace the later one is taken",
			                 entry.name, archive_path(before));
		entry = last->entry;
		totals->replaced++;
		status = walk_advance(walk, error);
	}
	return status ? status : record_copy(last->archive, &entry, options, &walk->likeness, writer, totals, error);
}

/* Every input at its first name. */
static bp_status walk_start(const struct bp_archive *const *archives, size_t count, struct input *inputs, struct walk *walk,
                            size_t *failed, bp_error *error)
{
	for (size_t n = 0; n < count; n++) {
		struct input *input = &inputs[n];
		input->archive = archives[n];
		input->number = n;
		input->count = bp_archive_count(archives[n]);
		if (input->count == 0)
			continue;
		*failed = n;
		const bp_status status = input_advance(input, walk, error);
		if (status)
			return status;
		walk->heap[walk->count++] = input;
	}
	for (size_t n = walk->count / 2; n-- > 0;)
		walk_sink(walk, n);
	return BP_OK;
}

bp_status archive_merge(const struct bp_archive *const *archives, size_t count, const struct copy_options *options,
                        struct copy_totals *totals, size_t *failed, bp_error *error)
{
	struct archive_writer *writer = NULL;
	struct input *inputs = calloc(count ? count : 1, sizeof *inputs);
	struct walk walk = {.heap = calloc(count ? count : 1, sizeof *walk.heap),
	                    .shards = options->shards,
	                    .seen = calloc(options->shards + 1, sizeof *walk.seen)};
	bp_status status = BP_OK;

	*totals = (struct copy_totals){0};
	*failed = 0;
	if (!inputs || !walk.heap || !walk.seen)
		status = error_memory(error, count * sizeof *inputs);
	if (!status) {
		status = walk_start(archives, count, inputs, &walk, failed, error);
		totals->reading = status != BP_OK;
	}
	if (!status)
		status = archive_writer_open(options->output, &writer, error);
	while (!status && walk.count && !stop_asked(options, totals))
		status = first_copy(&walk, options, writer, totals, failed, error);
	if (writer)
		status = writer_end(writer, status, totals, error);
	free(walk.seen);
	free(walk.heap);
	free(inputs);
	return status;
}

bp_status archive_reuse(const struct bp_archive *archive, const char *name, const struct record_source *source,
                        const struct fit_options *options, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	struct index_entry entry;
	struct record_head head;
	uint64_t index;

	*record = NULL;
	bp_status status = bp_archive_find(archive, name, &index, error);
	if (!status)
		status = archive_record_head(archive, index, &entry, &head, error);
	if (status == BP_ERROR_MEMORY || status == BP_ERROR_IO)
		return status;
	if (status || !record_answers(&head, source, options))
		return BP_OK;
	status = archive_entry_record(archive, &entry, &head, record, error);
	*record_bytes = head.record_bytes;
	return status == BP_ERROR_MEMORY || status == BP_ERROR_IO ? status : BP_OK;
}
