/*
 * compare.h: the parts of `brdfpack compare`: what a worker measures, and how rows are shown.
 *
 *     cmd_compare.c  finds the files, hands out materials, prints rows in their order
 *     compare_work.c in the worker: archive and measured file -> figures and pictures
 *     compare_report.c rows and summary as table or JSON
 */
#ifndef TOOL_COMPARE_COMPARE_H
#define TOOL_COMPARE_COMPARE_H

#include <stdio.h>

#include "render/comparison.h"
#include "tool/measured.h"
#include "tool/workers.h"

/* What a worker sends back: this, then the PNG files one after another. */
struct compare_result {
	struct comparison comparison;
	bool confirmed; /* packed from this very file, and the errors that the record tells of every layer are what was measured */
	uint32_t record_bytes;
	uint32_t png_bytes[LIGHTING_COUNT]; /* 0 where there is none */
};

/* One material that is compared. */
struct compare_item {
	const char *name;
	bool done, told; /* `told`: its error has been reported */
	bp_error error;  /* why it failed, reported in its turn; status BP_OK: it did not */
	struct compare_result result;
};

/* All that a worker needs; filled before the fork. */
struct compare_job {
	const struct bp_archive *archive;
	const struct measured_item *items;
	bool images;
	struct comparison_plans plans; /* a worker's own from the fork on */
	struct source_cursor cursor;
};

/* A worker_fn: job->number is the item's. */
bp_status compare_work(void *user, const struct job *job, int fd, uint8_t **record, size_t *record_bytes, bp_error *error);

/* How rows are printed; the first three are fixed before the first. */
struct compare_report {
	bool json;
	unsigned lightings;
	int name_width; /* columns of the widest name */
	bool headed;    /* the table's head has been printed */
};
void compare_report_row(struct compare_report *report, const struct compare_item *item);
/* Median, worst and mean of the items that did not fail, when there are any. */
bp_status compare_report_summary(const struct compare_report *report, const struct compare_item *items, size_t count,
                                 size_t failed_count, bp_error *error);

#endif
