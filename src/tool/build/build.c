#include "build.h"

#include "archive/writer.h"
#include "error.h"
#include "build_inputs.h"
#include "memory.h"
#include "outcomes.h"
#include "tool/command.h"
#include "tool/interrupt.h"
#include "tool/output_check.h"
#include "tool/progress.h"
#include "tool/report.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Hands out the listed items, then members of streams as they are read, until all results are in. */
static void work(struct build *build)
{
	bool streams = build->sources.stream_count > 0, ready = false;
	struct job job;

	while (build_goes_on(build)) {
		outcomes_show_progress(build);
		if (workers_idle(build->workers) && build->submitted < build->listed_count) {
			const size_t number = build->order[build->submitted++];
			struct job listed = {.number = number, .name = build->sources.items[number].name, .slot = -1};
			workers_submit(build->workers, &listed);
		} else if (workers_idle(build->workers) && ready) {
			workers_submit(build->workers, &job);
			ready = false;
		} else if (streams && !ready) {
			/* one member ahead of the workers, so that none waits for the decompression */
			ready = build_inputs_next(build, &job);
			streams = ready;
		} else if (workers_busy(build->workers) > 0) {
			workers_wait(build->workers, -1);
		} else {
			return;
		}
	}
}

/* What the manifest lists and no input has; known when all streams have been read. */
static void missing_report(struct build *build)
{
	bp_error error;
	for (size_t i = 0; i < build->manifest.count; i++) {
		const struct manifest_entry *entry = &build->manifest.entries[i];
		if (entry->found || !build_shard_has(build->options, entry->name))
			continue;
		error_set(&error, BP_ERROR_NOT_FOUND, BP_NO_OFFSET, "listed, but not among the inputs%s",
		          entry->other_form ? "; there is one of the same text in another Unicode form "
		                              "(letters and accents apart, or composed): list it as its file is called"
		                            : "");
		report_unpacked(build->options->manifest, entry->name, &error, build->options->json);
		build->totals.missing++;
	}
}

/* Journal -> archive, in name order. BP_OK without *written: a signal came. */
static bp_status archive_write(struct build *build, bool *written, bp_error *error)
{
	struct archive_writer *writer = NULL;
	uint8_t *record = NULL;
	size_t room = 0;
	bool stopped = false;

	items_sort(&build->items);
	bp_status status = archive_writer_open(build->options->output, &writer, error);
	for (size_t i = 0; i < build->items.count && !status && !(stopped = interrupt_came()); i++) {
		const struct item *item = &build->items.item[i];
		if (item->state != ITEM_PACKED)
			continue;
		record = memory_roomy(record, &room, item->record_bytes);
		status = record ? journal_read(&build->journal, item->journal_offset, record, item->record_bytes, error)
		                : error_memory(error, item->record_bytes);
		if (!status)
			status = archive_writer_add(writer, record, item->record_bytes, error);
		build->totals.archive_bytes += item->record_bytes;
	}
	free(record);
	if (status || stopped) {
		archive_writer_discard(writer);
		return status;
	}
	status = archive_writer_commit(writer, error);
	*written = !status;
	if (!status && !build->options->quiet)
		report_remark(build->options->output, error);
	return status;
}

/* That the output can be made, and is nothing that must stay: what was given first, then the files that were found there. */
static bp_status output_look(const struct build *build, bool found, bp_error *error)
{
	const struct build_options *options = build->options;
	const struct source_list *sources = &build->sources;
	bp_status status = BP_OK;
	if (!found) {
		if (options->manifest && !options->force)
			status = output_check_input(options->output, options->manifest, error);
		return status ? status
		              : output_check_path(options->output, OUTPUT_KIND_ARCHIVE, options->force,
		                                  (const char *const *)options->inputs, (size_t)options->input_count, error);
	}
	if (options->force || access(options->output, F_OK) != 0)
		return BP_OK;
	for (size_t n = 0; n < sources->item_count && !status; n++)
		status = output_check_input(options->output, sources->items[n].path, error);
	for (size_t n = 0; n < sources->stream_count && !status; n++)
		status = output_check_input(options->output, sources->streams[n].path, error);
	return status;
}

/* With --update: opens the archive that is there, before the workers are forked; none there is as good as an empty one. */
static bp_status previous_open(struct build *build, bp_error *error)
{
	struct stat facts;
	if (!build->options->update || (stat(build->options->output, &facts) != 0 && errno == ENOENT))
		return BP_OK;
	const bp_status status = bp_archive_open(build->options->output, &build->previous, error);
	const size_t used = status ? strlen(error->message) : 0;
	if (status == BP_ERROR_CORRUPT || status == BP_ERROR_CHECKSUM)
		snprintf(error->message + used, sizeof error->message - used, "; without --update everything is packed anew");
	return status;
}

/* There are materials, but none falls to this shard: its archive has none, and is as good as any for the merge. */
static bool shard_is_empty(const struct build *build)
{
	return build->options->shard_count > 1 && build->items.count == 0 && build->sources.unwanted_count > 0;
}

/* Where finished records go, and those that an interrupted build left. */
static bp_status records_open(struct build *build, bp_error *error)
{
	const struct build_options *options = build->options;
	char remark[JOURNAL_REMARK_BYTES];
	bp_status status = journal_open(options->output, &options->fit, options->update, &build->journal, remark, error);
	if (!status && *remark && !options->quiet)
		report_warning(options->output, NULL, "%s", remark);
	return status;
}

/* Everything up to the records in the journal. */
static void build_prepare_and_work(struct build *build)
{
	const struct build_options *options = build->options;
	bp_error error;
	int wake_fd;

	if (build_stops(build, options->output, output_look(build, false, &error), &error))
		return;
	if (options->manifest &&
	    build_stops(build, options->manifest, manifest_read(options->manifest, &build->manifest, &error), &error))
		return;
	build_inputs_collect(build);
	if (!build_goes_on(build))
		return;
	bool streams = build->sources.stream_count > 0;
	if (!streams)
		missing_report(build);
	if ((build->items.count == 0 && !streams && !shard_is_empty(build)) ||
	    (build->options->strict && !totals_whole(&build->totals)))
		return;
	if (build_stops(build, options->output, output_look(build, true, &error), &error) ||
	    build_stops(build, options->output, previous_open(build, &error), &error) ||
	    build_stops(build, options->output, records_open(build, &error), &error) ||
	    build_stops(build, NULL, interrupt_install(&wake_fd, &error), &error))
		return;
	unsigned count = options->workers;
	if (!streams && count > build->items.count)
		count = (unsigned)build->items.count;
	if (count == 0) /* an empty shard */
		return;
	struct workers_options pool = {.count = count,
	                               .slot_count = streams ? count + 1 : 0,
	                               .work = build_work,
	                               .work_user = build,
	                               .result = outcomes_take_result,
	                               .result_user = build,
	                               .wake_fd = wake_fd};
	if (build_stops(build, NULL, workers_start(&pool, &build->workers, &error), &error))
		return;
	progress_start(!options->quiet);
	work(build);
	progress_stop();
	if (streams && build_goes_on(build))
		missing_report(build);
}

static void empty_report(const struct build *build)
{
	char ignored[140] = "";
	if (build->sources.ignored_count > 0)
		snprintf(ignored, sizeof ignored, "; other files passed over: %zu (in a folder, measured ones end in .binary or .bsdf)",
		         build->sources.ignored_count);
	report_text("%s: not written: no material found in the inputs%s", build->options->output, ignored);
}

int build_run(const struct build_options *options)
{
	struct build build = {.options = options, .journal = {.fd = -1}};
	double start = clock_seconds();
	bool written = false;
	bp_error error;

	build_prepare_and_work(&build);
	workers_stop(build.workers);
	bp_archive_close(build.previous);
	container_close(build.stream);
	bool whole = totals_whole(&build.totals);
	if (build_goes_on(&build) && (build.totals.packed > 0 || shard_is_empty(&build)) && (whole || !options->strict))
		build_stops(&build, options->output, archive_write(&build, &written, &error), &error);
	build.totals.seconds = clock_seconds() - start;
	int signal_number = written ? 0 : interrupt_signal();
	/* With --strict a refusal is the answer; what else ended it may be mended. */
	const bool keep = !written && (signal_number || (build.stopped && !(options->strict && build.totals.refused > 0)));
	int code = written && whole ? EXIT_OK : EXIT_FAILED;
	if (signal_number)
		code = interrupt_exit(options->output);
	else if (!build.stopped && build.items.count == 0 && whole && !written)
		empty_report(&build);
	else
		report_summary(options, written, build.stopped, &build.totals, &build.sources);
	if (keep && journal_count(&build.journal) > 0)
		report_text("%s: finished records: %zu, kept in %s; the same build with --update goes on from them", options->output,
		            journal_count(&build.journal), build.journal.path);
	journal_close(&build.journal, keep);
	manifest_free(&build.manifest);
	items_free(&build.items);
	free(build.order);
	if (build.scanned)
		source_list_free(&build.sources);
	return code;
}
