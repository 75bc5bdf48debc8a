#include "outcomes.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "tool/progress.h"
#include "tool/report.h"

void outcomes_show_progress(const struct build *build)
{
	uint64_t done = build->totals.packed + build->totals.refused;
	if (build->sources.stream_count == 0)
		progress_show(done, build->items.count,
		              build->bytes_total > 0 ? (double)build->bytes_done / (double)build->bytes_total : 0);
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
	struct delivery *delivery = &outcome->delivery;
	if (result->record_bytes < sizeof *delivery)
		return error_set(error, BP_ERROR_CORRUPT, BP_NO_OFFSET, "the worker delivered no record");
	const size_t record_bytes = result->record_bytes - sizeof *delivery;
	memcpy(delivery, result->record, sizeof *delivery);
	bp_status status = record_head_read(result->record + sizeof *delivery, record_bytes, &outcome->head, error);
	if (!status && (outcome->head.record_bytes != record_bytes || strcmp(outcome->head.name, item->source.name) != 0))
		status = error_set(error, BP_ERROR_CORRUPT, BP_NO_OFFSET, "the worker delivered a damaged record");
	const struct manifest_entry *entry = manifest_find(&build->manifest, item->source.name);
	if (!status && entry)
		status = manifest_check(entry, delivery->source.bytes, delivery->source.sha256, error);
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
		const enum record_origin origin = outcome->delivery.origin;
		build->totals.reused += origin == RECORD_REUSED || origin == RECORD_RESUMED;
		build->totals.kept += origin == RECORD_KEPT;
		build->totals.source_bytes += outcome->delivery.source.bytes;
	}
	build->bytes_done += item_weight(&item->source);
	item->outcome = outcome;
	outcomes_report(build);
	outcomes_show_progress(build);
}

/* Where the record stands until the archive is written: there already, where it was resumed. */
static bp_status record_store(struct build *build, struct item *item, const struct outcome *outcome, const uint8_t *record,
                              bp_error *error)
{
	const struct journal_entry *entry =
		outcome->delivery.origin == RECORD_RESUMED ? journal_find(&build->journal, item->source.name) : NULL;
	item->record_bytes = outcome->head.record_bytes;
	if (!entry || entry->bytes != item->record_bytes)
		return journal_add(&build->journal, record, item->record_bytes, &item->journal_offset, error);
	item->journal_offset = entry->offset;
	return BP_OK;
}

static struct outcome *outcome_create(struct build *build)
{
	struct outcome *outcome = calloc(1, sizeof *outcome);
	if (!outcome) {
		bp_error error;
		error_memory(&error, sizeof *outcome);
		build_stop(build, NULL, &error);
	}
	return outcome;
}

void outcomes_refuse(struct build *build, uint64_t number, const bp_error *error)
{
	struct outcome *outcome = outcome_create(build);
	if (outcome) {
		outcome->error = *error;
		outcome_take(build, &build->items.item[number], outcome);
	}
}

void outcomes_take_result(void *user, const struct job_result *result)
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
		if (record_store(build, item, outcome, result->record + sizeof(struct delivery), &error)) {
			free(outcome);
			build_stop(build, build->options->output, &error);
			return;
		}
	}
	outcome_take(build, item, outcome);
}
