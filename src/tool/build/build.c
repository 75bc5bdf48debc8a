#include "build.h"

#include "archive/writer.h"
#include "error.h"
#include "build_state.h"
#include "tool/command.h"
#include "tool/interrupt.h"
#include "tool/progress.h"
#include "tool/report.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

bool build_goes_on(const struct build *build)
{
	return !build->stopped && !interrupt_signal();
}

void build_stop(struct build *build, const char *file, const char *material, const bp_error *error)
{
	report_error(file, material, error);
	build->stopped = true;
}

static void progress_update(const struct build *build)
{
	uint64_t done = build->totals.packed + build->totals.refused;
	if (build->sources.stream_count == 0)
		progress_show(done, build->items.count, build->bytes_total > 0 ? (double)build->bytes_done / (double)build->bytes_total : 0);
	else if (build->manifest.count > 0)
		progress_show(done, build->manifest.count, (double)done / (double)build->manifest.count);
	else
		progress_show(done, 0, -1); /* what a stream holds shows at its end */
}

/* Reports what is finished, in the items' order, so that the text does not depend on the workers' speed. */
static void outcomes_report(struct build *build)
{
	while (build->reported < build->items.count && build_goes_on(build)) {
		struct item *item = &build->items.item[build->reported];
		if (!item->outcome)
			return;
		report_material(item, item->outcome, build->options->json, build->options->quiet);
		free(item->outcome);
		item->outcome = NULL;
		build->reported++;
		if (item->state == ITEM_REFUSED && build->options->strict)
			build->stopped = true; /* no archive will come of it: why work on */
	}
}

/* Checks what a worker delivered, and the file it was made from against the manifest. */
static bp_status delivery_accept(struct build *build, struct item *item, const struct job_result *result, struct outcome *outcome,
                                 bp_error *error)
{
	struct delivery delivery;
	if (result->record_bytes < sizeof delivery)
		return error_set(error, BP_ERROR_CORRUPT, BP_NO_OFFSET, "the worker delivered no record");
	const size_t record_bytes = result->record_bytes - sizeof delivery;
	memcpy(&delivery, result->record, sizeof delivery);
	bp_status status = record_head_parse(result->record + sizeof delivery, record_bytes, &outcome->head, error);
	if (!status && (outcome->head.record_bytes != record_bytes || strcmp(outcome->head.name, item->source.name) != 0))
		status = error_set(error, BP_ERROR_CORRUPT, BP_NO_OFFSET, "the worker delivered a damaged record");
	const struct manifest_entry *entry = manifest_find(&build->manifest, item->source.name);
	if (!status && entry)
		status = manifest_check(entry, delivery.source.bytes, delivery.source.sha256, error);
	outcome->source = delivery.source;
	outcome->origin = delivery.origin;
	return status;
}

/* Files an outcome under its item, and reports all whose turn has come. */
static void outcome_take(struct build *build, struct item *item, struct outcome *outcome)
{
	if (outcome->error.status) {
		item->state = ITEM_REFUSED;
		build->totals.refused++;
	} else {
		item->state = ITEM_PACKED;
		build->totals.packed++;
		build->totals.reused += outcome->origin == RECORD_REUSED;
		build->totals.kept += outcome->origin == RECORD_KEPT;
		build->totals.source_bytes += outcome->source.bytes;
	}
	build->bytes_done += item->source.bytes != UINT64_MAX ? item->source.bytes : merl_file_bytes(LATTICE_MERL);
	item->outcome = outcome;
	outcomes_report(build);
	progress_update(build);
}

static struct outcome *outcome_create(struct build *build)
{
	struct outcome *outcome = calloc(1, sizeof *outcome);
	if (!outcome) {
		bp_error error;
		error_memory(&error, sizeof *outcome);
		build_stop(build, NULL, NULL, &error);
	}
	return outcome;
}

void build_refuse(struct build *build, uint64_t number, const bp_error *error)
{
	struct outcome *outcome = outcome_create(build);
	if (outcome) {
		outcome->error = *error;
		outcome_take(build, &build->items.item[number], outcome);
	}
}

static void result_take(void *user, const struct job_result *result)
{
	struct build *build = user;
	struct item *item = &build->items.item[result->number];
	bp_error error;

	if (build->stopped) /* by a result that came in with this one */
		return;
	struct outcome *outcome = outcome_create(build);
	if (!outcome)
		return;
	outcome->seconds = result->seconds;
	memcpy(outcome->stage_seconds, result->stage_seconds, sizeof outcome->stage_seconds);
	outcome->error = result->error;
	if (!outcome->error.status)
		delivery_accept(build, item, result, outcome, &outcome->error);
	if (!outcome->error.status) {
		const uint8_t *record = result->record + sizeof(struct delivery);
		if (spool_add(&build->spool, record, outcome->head.record_bytes, &item->spool_offset, &error)) {
			free(outcome);
			build_stop(build, build->options->output, NULL, &error);
			return;
		}
		item->record_bytes = outcome->head.record_bytes;
	}
	outcome_take(build, item, outcome);
}

/* Hands out the listed items in name order, then members of streams as they are read, until all results are in. */
static void work(struct build *build)
{
	bool streams = build->sources.stream_count > 0, ready = false;
	struct job job;

	while (build_goes_on(build)) {
		progress_update(build);
		if (workers_idle(build->workers) && build->submitted < build->listed_count) {
			struct job listed = {.number = build->submitted, .name = build->sources.items[build->submitted].name, .slot = -1};
			build->submitted++;
			workers_submit(build->workers, &listed);
		} else if (workers_idle(build->workers) && ready) {
			workers_submit(build->workers, &job);
			ready = false;
		} else if (streams && !ready) {
			/* one member ahead of the workers, so that none waits for the decompression */
			ready = build_stream_next(build, &job);
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
	const bp_error error = {BP_ERROR_NOT_FOUND, BP_NO_OFFSET, "listed, but not among the inputs"};
	for (size_t i = 0; i < build->manifest.count; i++)
		if (!build->manifest.entries[i].found) {
			report_error(build->options->manifest, build->manifest.entries[i].name, &error);
			build->totals.missing++;
		}
}

/* Spool -> archive, in name order. BP_OK without *written: a signal came. */
static bp_status archive_write(struct build *build, bool *written, bp_error *error)
{
	struct archive_writer *writer = NULL;
	uint8_t *record = NULL;
	size_t room = 0;
	bp_status status;

	items_sort(&build->items);
	status = archive_writer_open(build->options->output, &writer, error);
	for (size_t i = 0; i < build->items.count && !status; i++) {
		const struct item *item = &build->items.item[i];
		if (item->state != ITEM_PACKED)
			continue;
		if (interrupt_signal()) {
			archive_writer_discard(writer);
			free(record);
			return BP_OK;
		}
		if (item->record_bytes > room) {
			free(record);
			room = 2 * (size_t)item->record_bytes;
			record = malloc(room);
			if (!record) {
				status = error_memory(error, room);
				break;
			}
		}
		status = spool_read(&build->spool, item->spool_offset, record, item->record_bytes, error);
		if (!status)
			status = archive_writer_add(writer, record, item->record_bytes, error);
		build->totals.archive_bytes += item->record_bytes;
	}
	free(record);
	if (status) {
		archive_writer_discard(writer);
		return status;
	}
	status = archive_writer_commit(writer, error);
	*written = !status;
	return status;
}

/* The archive writer would refuse it as well, but only when all the work is done. */
static bp_status output_refuse(const char *output, bp_error *error)
{
	struct stat facts;
	if (stat(output, &facts) == 0 && !S_ISREG(facts.st_mode))
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "is %s, not a regular file", S_ISDIR(facts.st_mode) ? "a folder" : "something else");
	return BP_OK;
}

/* With --update: opens the archive that is there, before the workers are forked; none there is as good as an empty one. */
static bp_status previous_open(struct build *build, bp_error *error)
{
	struct stat facts;
	if (!build->options->update || (stat(build->options->output, &facts) != 0 && errno == ENOENT))
		return BP_OK;
	return bp_archive_open(build->options->output, &build->previous, error);
}

/* Everything up to the records in the spool. */
static void build_prepare_and_work(struct build *build)
{
	const struct build_options *options = build->options;
	bp_error error;
	int wake_fd;

	if (options->manifest && manifest_read(options->manifest, &build->manifest, &error)) {
		build_stop(build, options->manifest, NULL, &error);
		return;
	}
	build_inputs_collect(build);
	if (!build_goes_on(build))
		return;
	bool streams = build->sources.stream_count > 0;
	if (!streams)
		missing_report(build);
	if ((build->items.count == 0 && !streams) || (build->options->strict && !totals_whole(&build->totals)))
		return;
	if (output_refuse(options->output, &error) || previous_open(build, &error) || spool_open(options->output, &build->spool, &error)) {
		build_stop(build, options->output, NULL, &error);
		return;
	}
	if (interrupt_install(&wake_fd, &error)) {
		build_stop(build, NULL, NULL, &error);
		return;
	}
	unsigned count = options->workers;
	if (!streams && count > build->items.count)
		count = (unsigned)build->items.count;
	struct workers_options pool = {.count = count,
	                               .slot_count = streams ? count + 1 : 0,
	                               .work = build_work,
	                               .work_user = build,
	                               .result = result_take,
	                               .result_user = build,
	                               .wake_fd = wake_fd};
	if (workers_start(&pool, &build->workers, &error)) {
		build_stop(build, NULL, NULL, &error);
		return;
	}
	progress_start(!options->quiet);
	work(build);
	progress_stop();
	if (streams && build_goes_on(build))
		missing_report(build);
}

static void empty_report(const struct build *build)
{
	char ignored[100] = "";
	if (build->sources.ignored_count > 0)
		snprintf(ignored, sizeof ignored, "; other files passed over: %zu (in a folder, MERL files end in .binary)",
		         build->sources.ignored_count);
	report_text("%s: not written: no material found in the inputs%s", build->options->output, ignored);
}

int build_run(const struct build_options *options)
{
	struct build build = {.options = options, .spool = {.fd = -1}};
	double start = clock_seconds();
	bool written = false;
	bp_error error;

	build_prepare_and_work(&build);
	workers_stop(build.workers);
	bp_archive_close(build.previous);
	container_close(build.stream);
	bool whole = totals_whole(&build.totals);
	if (build_goes_on(&build) && build.totals.packed > 0 && (whole || !options->strict)) {
		if (archive_write(&build, &written, &error))
			build_stop(&build, options->output, NULL, &error);
	}
	build.totals.seconds = clock_seconds() - start;
	int signal_number = written ? 0 : interrupt_signal();
	if (signal_number)
		report_text("%s: interrupted; not written", options->output);
	else if (!build.stopped && build.items.count == 0 && whole)
		empty_report(&build);
	else
		report_summary(options, written, build.stopped, &build.totals);
	manifest_free(&build.manifest);
	items_free(&build.items);
	if (build.scanned)
		source_list_free(&build.sources);
	spool_close(&build.spool);
	return signal_number ? 128 + signal_number : written && whole ? EXIT_OK : EXIT_FAILED;
}
