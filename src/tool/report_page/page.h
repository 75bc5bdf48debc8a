/*
 * page.h: the page that `brdfpack report` writes.
 *
 *     page.c           archive -> items -> workers -> the page, written whole
 *     page_work.c      in the worker: one material -> its part of the page
 *     page_plots.c     line plots as SVG, in the page's own colours
 *     page_sections.c  the parts that are about the archive: heading, scatter plot, worst ten, what verify said
 *     page.css, page.js  how it looks; filter and sort. page_assets.inc has them as text.
 */
#ifndef TOOL_REPORT_PAGE_PAGE_H
#define TOOL_REPORT_PAGE_PAGE_H

#include <stdbool.h>

#include "tool/command.h"
#include "tool/selection.h"

struct page_options {
	const char *output;
	const char *measured; /* folder of measured files, or NULL */
	unsigned lightings;   /* bit 1 << lighting */
	unsigned workers;
	bool quiet;
	bool embed; /* the archive's bytes stand in the page */
};

/* Beyond so many materials the page is a contact sheet only: it stays readable, and under 50 MB for 10,000. */
enum { PAGE_DETAILS_MAX = 150 };

/* Writes the page. Everything has been said; returns an exit code, EXIT_FAILED too where a material is missing in the page. */
int page_run(const struct page_options *options, struct selection *selection);

#endif
