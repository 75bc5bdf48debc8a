/* page_work.h: one material -> its part of the page, in a worker. */
#ifndef TOOL_REPORT_PAGE_PAGE_WORK_H
#define TOOL_REPORT_PAGE_PAGE_WORK_H

#include "page.h"
#include "render/comparison.h"
#include "tool/measured.h"
#include "tool/workers.h"

/* What a worker sends back: this, then the HTML of the contact sheet's item, then that of the details. */
struct page_result {
	uint32_t record_bytes;
	uint32_t layer_count;
	uint32_t layer_bytes[LAYERS_MAX];
	double layer_error[LAYERS_MAX]; /* log RMSE of what can be seen */
	double albedo;                  /* the largest directional one */
	bool measured;                  /* compared with its file */
	double psnr[LIGHTING_COUNT];    /* float, where measured, of the lightings that were asked for */
	uint32_t sheet_bytes, details_bytes;
};

/* All that a worker needs; filled before the fork. */
struct page_job {
	const struct bp_archive *archive;
	const struct measured_item *items;
	bool details, measured;        /* measured files were asked for */
	struct comparison_plans plans; /* a worker's own from the fork on */
	struct source_cursor cursor;
};

worker_fn page_work; /* its user is a struct page_job, job->number the item's */

#endif
