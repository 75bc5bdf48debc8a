#include "page_sections.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "page_assets.inc"
#include "page_html.h"
#include "page_plots.h"
#include "tool/output_check.h"

enum { WORST_COUNT = 10 };

/* The last part of a path. */
static const char *path_leaf(const char *path)
{
	const char *slash = strrchr(path, '/');
	return slash && slash[1] ? slash + 1 : path;
}

void page_head_write(FILE *out, const struct page *page)
{
	const char *leaf = path_leaf(page->selection->path);
	const uint64_t all = bp_archive_count(page->selection->archive);
	fputs(PAGE_MARK
	      "<html lang=en><head><meta charset=utf-8><meta name=viewport content=\"width=device-width, initial-scale=1\">\n<title>",
	      out);
	html_text(out, leaf);
	fputs("</title>\n<style>\n", out);
	fputs(PAGE_CSS, out);
	fputs("</style></head>\n<body data-archive=\"", out);
	html_text(out, leaf);
	fputs("\"><a class=skip href=\"#sheet\">to the materials</a>\n<header><h1>", out);
	html_name(out, leaf);
	fprintf(out, "</h1><p>%llu material%s", (unsigned long long)all, all == 1 ? "" : "s");
	if (page->count < all)
		fprintf(out, ", %zu of them here", page->count);
	fprintf(out, ", %llu bytes. ", (unsigned long long)page->archive_bytes);
	if (page->problem_count)
		fprintf(out, "<a class=warning href=\"#verify\">verify found %zu problem%s.</a> ", page->problem_count,
		        page->problem_count == 1 ? "" : "s");
	if (page->failed)
		fprintf(out, "<strong class=warning>%zu material%s could not be decoded.</strong> ", page->failed,
		        page->failed == 1 ? "" : "s");
	fputs("Made by brdfpack " BP_VERSION ".</p></header>\n", out);
}

static void controls_write(FILE *out)
{
	fputs("<form id=controls class=controls hidden role=search>"
	      "<label>name contains <input type=search id=filter autocomplete=off></label> "
	      "<label>sort by <select id=sort>"
	      "<option value=name>name"
	      "<option value=bytes>bytes"
	      "<option value=error>error (log RMSE)"
	      "<option value=albedo>largest albedo"
	      "<option value=colour>colour"
	      "</select></label> "
	      "<label><input type=checkbox id=down> largest first</label> "
	      "<span id=shown role=status></span></form>\n",
	      out);
}

void page_sheet_write(FILE *out, const struct page *page)
{
	fputs("<main>\n<section id=sheet aria-labelledby=sheet-h><h2 id=sheet-h>Materials</h2>\n", out);
	if (page->count == 0) {
		fputs("<p>There is no material in this archive.</p></section>\n", out);
		return;
	}
	controls_write(out);
	fputs("<p class=note>Under each sphere: the record's bytes, and its log RMSE against the measured table, "
	      "over the cells that can be seen (those wholly below the horizon are left out).",
	      out);
	if (!page->details)
		fputs(" With so many materials this page shows no more of each; "
		      "<code>brdfpack report ARCHIVE NAME…</code> shows all of those that are named.",
		      out);
	fputs("</p>\n<ul class=sheet>\n", out);
	for (size_t n = 0; n < page->count; n++) {
		const struct page_outcome *outcome = &page->outcomes[n];
		if (outcome->html) {
			fwrite(outcome->html, 1, outcome->result.sheet_bytes, out);
			continue;
		}
		fputs("<li class=\"tile missing\" data-name=\"", out);
		html_text(out, page->measured.name[n]);
		fputs("\"><span class=\"ball hole\" aria-hidden=true>?</span><span class=name>", out);
		html_name(out, page->measured.name[n]);
		fputs("</span><small>missing: ", out);
		html_text(out, outcome->fault ? outcome->fault : "not decoded");
		fputs("</small></li>\n", out);
	}
	fputs("</ul></section>\n", out);
}

static double last_error(const struct page_outcome *outcome)
{
	return outcome->result.layer_count ? outcome->result.layer_error[outcome->result.layer_count - 1] : 0;
}

static int worse_first(const void *a, const void *b)
{
	const struct page_outcome *x = *(const struct page_outcome *const *)a, *y = *(const struct page_outcome *const *)b;
	const double p = last_error(x), q = last_error(y);
	return p != q ? (p < q) - (p > q) : (x > y) - (x < y);
}

static void worst_write(FILE *out, const struct page *page, const struct page_outcome **order, size_t count)
{
	bool compared = false;
	char caption[64];
	qsort(order, count, sizeof *order, worse_first);
	for (size_t n = 0; n < count; n++)
		compared |= order[n]->result.measured;
	snprintf(caption, sizeof caption, "The %zu with the largest error", count < WORST_COUNT ? count : WORST_COUNT);
	html_table(out, caption, "material", "bytes", "log RMSE", "largest albedo", NULL);
	for (int l = 0; compared && l < LIGHTING_COUNT; l++)
		if (page->options->lightings >> l & 1)
			fprintf(out, "<th scope=col>PSNR %s (dB)", lighting_name((enum lighting)l));
	fputs("</tr></thead><tbody>", out);
	for (size_t n = 0; n < count && n < WORST_COUNT; n++) {
		const struct page_outcome *outcome = order[n];
		const struct measured_item *item = &page->measured.item[outcome - page->outcomes];
		fputs("<tr><th scope=row>", out);
		if (page->details)
			fprintf(out, "<a href=\"#m%llu\">", (unsigned long long)item->entry.ordinal);
		html_name(out, item->entry.name);
		fprintf(out, "%s<td>%u<td>%.5f<td>%.3f", page->details ? "</a>" : "", outcome->result.record_bytes, last_error(outcome),
		        outcome->result.albedo);
		for (int l = 0; compared && l < LIGHTING_COUNT; l++)
			if (page->options->lightings >> l & 1 && outcome->result.measured)
				fprintf(out, "<td>%.2f", outcome->result.psnr[l]);
			else if (page->options->lightings >> l & 1)
				fputs("<td>not compared", out);
		fputs("</tr>", out);
	}
	fputs("</tbody></table>\n", out);
}

bp_status page_archive_write(FILE *out, const struct page *page, bp_error *error)
{
	const struct page_outcome **order = calloc(page->count + 1, sizeof *order);
	struct plot_ladder *ladders = calloc(page->count + 1, sizeof *ladders);
	size_t count = 0;
	if (!order || !ladders) {
		free(order);
		free(ladders);
		return error_memory(error, page->count * (sizeof *order + sizeof *ladders));
	}
	fputs("<section id=archive aria-labelledby=archive-h><h2 id=archive-h>The archive</h2>\n", out);
	for (size_t n = 0; n < page->count; n++) {
		const struct page_outcome *outcome = &page->outcomes[n];
		if (!outcome->html)
			continue;
		ladders[count] = (struct plot_ladder){page->measured.name[n], outcome->result.layer_count, outcome->result.layer_bytes,
		                                      outcome->result.layer_error};
		order[count++] = outcome;
	}
	if (count) {
		plot_ladders(out, ladders, count);
		worst_write(out, page, order, count);
	}
	free(order);
	free(ladders);
	fprintf(out,
	        "<section id=verify aria-labelledby=verify-h><h3 id=verify-h>What verify said</h3>"
	        "<p>All checksums, the index and the order of the names were checked, "
	        "and %zu of %zu materials decoded for this page: %s</p>",
	        page->count - page->failed, page->count, page->problem_count || page->failed ? "" : "no problem found.");
	if (page->problem_count) {
		fputs("<ul>", out);
		fwrite(page->verify.bytes, 1, page->verify.count, out);
		fputs("</ul>", out);
	}
	fputs("</section></section>\n", out);
	return BP_OK;
}

void page_end_write(FILE *out)
{
	fputs("</main>\n<script>\n", out);
	fputs(PAGE_JS, out);
	fputs("</script>\n</body></html>\n", out);
}
