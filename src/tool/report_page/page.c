#include "page.h"

#include <libgen.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.h"
#include "memory_stream.h"
#include "output_file.h"
#include "page_html.h"
#include "page_sections.h"
#include "page_work.h"
#include "render/base64.h"
#include "tool/interrupt.h"
#include "tool/progress.h"
#include "tool/report.h"
#include "tool/whole_file.h"

/* A page of 512 pixels would be ten times as large and show nothing more. */
enum { SIZE_DETAILS = SPHERE_SIZE, SIZE_SHEET = 40, EMBED_BYTES_MAX = 512 << 20, PROBLEMS_MAX = 1000 };

/* Where the index is damaged the materials before that are shown. */
static bp_status items_read(struct page *page, bp_error *error)
{
	const bp_status status = measured_set_read(page->selection, &page->measured, error);
	if (status == BP_ERROR_MEMORY)
		return status;
	if (status != BP_OK) {
		report_error(page->selection->path, NULL, error);
		page->selection->incomplete = true;
	}
	page->count = page->measured.count;
	page->outcomes = calloc(page->count + 1, sizeof *page->outcomes);
	return page->outcomes ? BP_OK : error_memory(error, page->count * sizeof *page->outcomes);
}

static int problem_note(void *user, const bp_problem *problem)
{
	struct page *page = user;
	char text[1024];
	FILE *out = memory_stream_open(&page->verify);
	page->problem_count++;
	if (!out)
		return 1;
	error_describe(&problem->error, text, sizeof text);
	fputs("<li>", out);
	if (problem->material) {
		html_name(out, problem->material);
		fputs(": ", out);
	}
	html_text(out, text);
	fputs("</li>\n", out);
	fclose(out);
	return page->problem_count >= PROBLEMS_MAX;
}

/* The viewer's part of the page, as `make viewer` leaves it beside the tool and `make install` under share; none is no error. */
static void viewer_find(struct page *page)
{
	static const char *const PLACES[] = {"viewer/viewer.html", "../share/brdfpack/viewer.html"};
	char self[4096], path[4200];
	const ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
	if (length <= 0)
		return;
	self[length] = '\0';
	const char *folder = dirname(self);
	for (size_t n = 0; !page->viewer && n < sizeof PLACES / sizeof *PLACES; n++) {
		snprintf(path, sizeof path, "%s/%s", folder, PLACES[n]);
		if (access(path, R_OK) == 0)
			whole_file_read(path, 16 << 20, &page->viewer, &page->viewer_bytes, NULL);
	}
}

static void result_take(void *user, const struct job_result *result)
{
	struct page *page = user;
	struct page_outcome *outcome = &page->outcomes[result->number];
	const size_t head = sizeof outcome->result;
	bp_error error = result->error;
	if (!error.status && result->record_bytes >= head)
		memcpy(&outcome->result, result->record, head);
	if (!error.status && result->record_bytes != head + outcome->result.sheet_bytes + outcome->result.details_bytes) {
		error_set(&error, BP_ERROR_IO, BP_NO_OFFSET, "the worker's answer is not whole");
	} else if (!error.status) {
		if ((outcome->html = malloc(result->record_bytes - head + 1)))
			memcpy(outcome->html, result->record + head, result->record_bytes - head);
		else
			error_memory(&error, result->record_bytes);
	}
	if (error.status) {
		char text[1024];
		error_describe(&error, text, sizeof text);
		outcome->fault = strdup(text);
		report_error(page->selection->path, page->measured.name[result->number], &error);
		page->failed++;
	}
	page->done++;
	progress_show(page->done, page->count, (double)page->done / (double)page->count);
}

static bp_status materials_draw(struct page *page, bp_error *error)
{
	const struct page_options *options = page->options;
	page->job = (struct page_job){.archive = page->selection->archive,
	                              .items = page->measured.item,
	                              .details = page->details,
	                              .measured = options->measured != NULL,
	                              .plans = {.lightings = options->lightings, .size = page->details ? SIZE_DETAILS : SIZE_SHEET}};
	const struct workers_options pool = {
		.count = options->workers, .work = page_work, .work_user = &page->job, .result = result_take, .result_user = page};
	bp_status status = selection_plans_make(page->selection, &page->job.plans, error);
	progress_start(!options->quiet);
	if (status == BP_OK)
		status = workers_run(&pool, page->measured.name, page->count, error);
	progress_stop();
	return status;
}

static bp_status archive_embed(FILE *out, const struct page *page, bp_error *error)
{
	char *bytes;
	size_t count;
	bp_error reason;
	bp_status status = whole_file_read(page->selection->path, EMBED_BYTES_MAX, &bytes, &count, &reason);
	if (status != BP_OK)
		return error_set(error, status, reason.offset, "%s: %s%s", page->selection->path, reason.message,
		                 status == BP_ERROR_LIMIT ? " do not fit into a page; serve it beside the page instead" : "");
	fputs("<script type=\"application/x-brdfpack\" id=embedded>", out);
	base64_write(out, (const uint8_t *)bytes, count);
	fputs("</script>\n", out);
	free(bytes);
	return BP_OK;
}

/* The output as a stream; what went wrong first is kept. */
struct output {
	struct output_file file;
	bp_error error;
};

static ssize_t output_stream_write(void *user, const char *bytes, size_t count)
{
	struct output *output = user;
	if (!output->error.status && output_file_write(&output->file, bytes, count, &output->error) == BP_OK)
		return (ssize_t)count;
	return 0;
}

static bp_status page_write(const struct page *page, struct output *output, bp_error *error)
{
	FILE *out = fopencookie(output, "w", (cookie_io_functions_t){.write = output_stream_write});
	bp_status status = out ? BP_OK : error_memory(error, BUFSIZ);
	if (status != BP_OK)
		return status;
	page_head_write(out, page);
	if (page->options->embed)
		status = archive_embed(out, page, error);
	if (page->viewer)
		fwrite(page->viewer, 1, page->viewer_bytes, out);
	page_sheet_write(out, page);
	if (status == BP_OK)
		status = page_archive_write(out, page, error);
	if (page->details && page->count)
		fputs("<section id=details aria-labelledby=details-h><h2 id=details-h>Each material</h2>\n", out);
	for (size_t n = 0; page->details && n < page->count; n++)
		if (page->outcomes[n].html)
			fwrite(page->outcomes[n].html + page->outcomes[n].result.sheet_bytes, 1, page->outcomes[n].result.details_bytes, out);
	if (page->details && page->count)
		fputs("</section>\n", out);
	page_end_write(out);
	fclose(out);
	if (status == BP_OK && output->error.status) {
		*error = output->error;
		status = error->status;
	}
	return status == BP_OK ? output_file_commit(&output->file, error) : status;
}

static void page_free(struct page *page)
{
	for (size_t n = 0; page->outcomes && n < page->count; n++) {
		free(page->outcomes[n].html);
		free(page->outcomes[n].fault);
	}
	free(page->outcomes);
	free(page->viewer);
	byte_buffer_free(&page->verify);
	measured_set_free(&page->measured);
	comparison_plans_free(&page->job.plans);
}

/* Finds the measured files, and says where some are not there: the folder may be another one than was meant. */
static bp_status measured_find(struct page *page, const char *folder, bp_error *error)
{
	const struct measured_set *set = &page->measured;
	const char *first = NULL;
	size_t missing = 0;
	const bp_status status = measured_set_find(&page->measured, folder, error);
	for (size_t n = 0; status == BP_OK && n < set->count; n++)
		if (!set->item[n].source)
			first = missing++ ? first : set->name[n];
	if (missing > 0)
		report_warning(folder, NULL, "no measured file of %zu of %zu materials, '%s' the first of them; these are shown alone",
		               missing, set->count, first);
	return status;
}

int page_run(const struct page_options *options, struct selection *selection)
{
	struct page made = {.options = options, .selection = selection}, *page = &made;
	struct output output = {.file.fd = -1};
	struct stat facts;
	bp_error error;
	page->details = selection->count <= PAGE_DETAILS_MAX;
	page->archive_bytes = stat(selection->path, &facts) == 0 ? (uint64_t)facts.st_size : 0;
	viewer_find(page);
	bp_status status = items_read(page, &error);
	if (status == BP_OK && options->embed && !page->viewer)
		status = error_argument(&error, "--embed: the viewer is not there, so nothing could read the archive; "
		                                "`make viewer` builds it (Debian package emscripten)");
	if (status == BP_OK && options->measured)
		status = measured_find(page, options->measured, &error);
	if (status == BP_OK) /* before the work, so that nobody waits for what cannot be written */
		status = output_file_open(options->output, OUTPUT_REPLACE, &output.file, &error);
	if (status == BP_OK) {
		bp_archive_verify(selection->archive, 0, problem_note, page, NULL);
		status = materials_draw(page, &error);
	}
	const bool stopped = interrupt_came();
	if (status == BP_OK && !stopped)
		status = page_write(page, &output, &error);
	if (status != BP_OK && !stopped)
		report_error(NULL, NULL, &error);
	output_file_discard(&output.file);
	const bool whole = status == BP_OK && !page->failed && !page->problem_count && !selection->incomplete;
	page_free(page);
	return stopped ? interrupt_exit(options->output) : whole ? EXIT_OK : EXIT_FAILED;
}
