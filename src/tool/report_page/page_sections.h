/* page_sections.h: the parts of the page that are about the archive. */
#ifndef TOOL_REPORT_PAGE_PAGE_SECTIONS_H
#define TOOL_REPORT_PAGE_PAGE_SECTIONS_H

#include <stdio.h>

#include "bytes.h"
#include "page_work.h"

/* What became of one material. */
struct page_outcome {
	struct page_result result;
	char *html;  /* its item of the contact sheet, then its details: lengths are in result; NULL where it failed */
	char *fault; /* else: why, as report_error says it */
};

/* Everything the page is made of. */
struct page {
	const struct page_options *options;
	struct selection *selection;
	struct measured_set measured;
	struct page_job job; /* what workers know of it */
	struct page_outcome *outcomes;
	size_t count, done, failed;
	bool details;
	uint64_t archive_bytes;    /* all of the file */
	struct byte_buffer verify; /* what verify said: HTML list items */
	size_t problem_count;
	char *viewer; /* the viewer's part of the page, or NULL: it was not built */
	size_t viewer_bytes;
};

void page_head_write(FILE *out, const struct page *page);
void page_sheet_write(FILE *out, const struct page *page);
void page_end_write(FILE *out);
/* BP_ERROR_MEMORY: without the materials' order. */
bp_status page_archive_write(FILE *out, const struct page *page, bp_error *error);

#endif
