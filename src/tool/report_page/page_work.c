#include "page_work.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory_stream.h"
#include "model/math/select.h"
#include "page_html.h"
#include "page_plots.h"
#include "tool/facts.h"
#include "tool/material.h"

/* What is known of the material while its part of the page is made. */
struct subject {
	const struct measured_item *item;
	struct record_head head;
	struct expansion table;
	struct lattice lattice; /* the measured file; alloc'ed only where there is one */
	bool measured;
	struct comparison comparison;
	struct energy energy;                   /* of the decoded table */
	struct picture spheres[LIGHTING_COUNT]; /* decoded alone, or measured | decoded | difference */
	char missing[640];                      /* why there is no comparison, though one was asked for */
};

static void subject_free(struct subject *subject)
{
	expansion_free(&subject->table);
	lattice_free(&subject->lattice);
	for (int l = 0; l < LIGHTING_COUNT; l++)
		picture_free(&subject->spheres[l]);
}

static const char *lighting_label(int lighting)
{
	static const char *const LABEL[LIGHTING_COUNT] = {"29 directional lights", "a sky with one window", "4 point lights"};
	return LABEL[lighting];
}

/* Spheres and albedo of the decoded table alone. */
static bp_status decoded_draw(struct page_job *job, struct subject *subject, bp_error *error)
{
	struct comparison_plans *plans = &job->plans;
	struct lookup_table lookup = {0};
	double exposure;
	bp_status status = comparison_plans_make(plans, subject->head.dims, error);
	if (status == BP_OK)
		status = material_lookup(&subject->head, &subject->table, &lookup, error);
	if (status != BP_OK)
		return status;
	energy_measure(plans->energy, &lookup, &subject->energy);
	for (int l = 0; status == BP_OK && l < LIGHTING_COUNT; l++) {
		if (!plans->plans[l])
			continue;
		sphere_plan_render(plans->plans[l], (const struct lookup_table *[]){&lookup}, 1,
		                   (struct sphere_image *[]){&plans->estimate});
		status = image_exposure(&plans->estimate, &exposure, error);
		if (status == BP_OK)
			status = picture_alloc(plans->size, plans->size, &subject->spheres[l], error);
		if (status == BP_OK)
			picture_place(&subject->spheres[l], 0, &plans->estimate, exposure);
	}
	lookup_table_free(&lookup);
	return status;
}

/* The same beside the measured table. A file that cannot be read is told in the page, and the material is drawn alone. */
static bp_status measured_draw(struct page_job *job, struct subject *subject, bp_error *error)
{
	bp_error reason;
	bp_status status = measured_read(subject->item->source, &job->cursor, &subject->head, &subject->lattice, NULL, &reason);
	const bool read = status == BP_OK;
	if (read)
		status =
			comparison_measure(&job->plans, &subject->lattice, &subject->table, &subject->comparison, subject->spheres, &reason);
	subject->measured = status == BP_OK;
	subject->energy = subject->comparison.decoded;
	if (status == BP_OK)
		return BP_OK;
	snprintf(subject->missing, sizeof subject->missing, "not compared: %s%s%s", read ? subject->item->source->path : "",
	         read ? ": " : "", reason.message);
	for (int l = 0; l < LIGHTING_COUNT; l++)
		picture_free(&subject->spheres[l]);
	return status == BP_ERROR_MEMORY ? error_memory(error, 0) : decoded_draw(job, subject, error);
}

/* The decoded sphere, `factor` times smaller. */
static bp_status thumbnail_make(const struct subject *subject, uint32_t factor, struct picture *out, bp_error *error)
{
	const struct picture *from = NULL;
	for (int l = LIGHTING_COUNT; l-- > 0;)
		from = subject->spheres[l].rgb ? &subject->spheres[l] : from;
	const uint32_t size = from->height / factor, first = from->width > from->height ? from->height : 0;
	bp_status status = picture_alloc(size, size, out, error);
	for (uint32_t y = 0; status == BP_OK && y < size; y++)
		for (uint32_t x = 0; x < size; x++)
			for (uint32_t c = 0; c < 3; c++) {
				uint32_t sum = 0;
				for (uint32_t n = 0; n < factor * factor; n++)
					sum += from->rgb[3 * (first + factor * x + n % factor + (size_t)from->width * (factor * y + n / factor)) + c];
				out->rgb[3 * (x + (size_t)size * y) + c] = (uint8_t)((sum + factor * factor / 2) / (factor * factor));
			}
	return status;
}

/* Hue in degrees of the sphere's mean colour, for sorting; greys come last, by 360 and their darkness. */
static double picture_hue(const struct picture *picture)
{
	double mean[3] = {0, 0, 0}, all = 0;
	const size_t pixels = (size_t)picture->width * picture->height;
	for (size_t n = 0; n < pixels; n++)
		for (int c = 0; c < 3; c++)
			mean[c] += picture->rgb[3 * n + (size_t)c];
	for (int c = 0; c < 3; c++)
		all += mean[c];
	const double top = fmax(mean[0], fmax(mean[1], mean[2])), low = fmin(mean[0], fmin(mean[1], mean[2])), range = top - low;
	if (range <= 0.08 * top)
		return 720 - all / (double)(pixels * 3);
	const double sixth = top == mean[0]   ? (mean[1] - mean[2]) / range
	                     : top == mean[1] ? 2 + (mean[2] - mean[0]) / range
	                                      : 4 + (mean[0] - mean[1]) / range;
	return fmod(60 * sixth + 360, 360);
}

static bp_status sheet_write(FILE *out, const struct page_job *job, const struct subject *subject, bp_error *error)
{
	const struct fidelity *fidelity = head_fidelity(&subject->head);
	const char *name = subject->head.name;
	char alt[512];
	struct picture thumbnail = {0};
	bp_status status = thumbnail_make(subject, job->details ? 2 : 1, &thumbnail, error);
	if (status != BP_OK)
		return status;
	fprintf(out, "<li class=tile data-name=\"");
	html_text(out, name);
	fprintf(out, "\" data-index=%llu data-bytes=%u data-error=%.6g data-albedo=%.4f data-colour=%.2f><a",
	        (unsigned long long)subject->item->entry.ordinal, subject->head.record_bytes, fidelity->seen_log_rmse,
	        subject->energy.largest, picture_hue(&thumbnail));
	if (job->details)
		fprintf(out, " href=\"#m%llu\"", (unsigned long long)subject->item->entry.ordinal);
	fputs(">", out);
	snprintf(alt, sizeof alt, "sphere of %s: %u bytes, log RMSE %.3g, largest albedo %.2f", name, subject->head.record_bytes,
	         fidelity->seen_log_rmse, subject->energy.largest);
	status = html_picture(out, &thumbnail, "ball", alt, error);
	picture_free(&thumbnail);
	fputs("<span class=name>", out);
	html_name(out, name);
	fprintf(out, "</span></a><small>%u B · %.2g</small></li>\n", subject->head.record_bytes, fidelity->seen_log_rmse);
	return status;
}

static bp_status spheres_write(FILE *out, const struct subject *subject, bp_error *error)
{
	bp_status status = BP_OK;
	fputs("<div class=spheres>", out);
	for (int l = 0; status == BP_OK && l < LIGHTING_COUNT; l++) {
		const struct picture *picture = &subject->spheres[l];
		char alt[512];
		if (!picture->rgb)
			continue;
		fprintf(out, "<figure class=light-%s>", lighting_name((enum lighting)l));
		if (subject->measured)
			snprintf(alt, sizeof alt,
			         "%s under %s: measured, decoded, and their difference times ten; "
			         "PSNR %.2f dB, mean colour difference %.3g dE ITP",
			         subject->head.name, lighting_label(l), subject->comparison.psnr[l].real, subject->comparison.itp[l]);
		else
			snprintf(alt, sizeof alt, "sphere of %s under %s", subject->head.name, lighting_label(l));
		status = html_picture(out, picture, subject->measured ? "strip" : "ball", alt, error);
		fprintf(out, "<figcaption>%s: %s", lighting_name((enum lighting)l), lighting_label(l));
		if (subject->measured)
			fprintf(out, "<br>measured, decoded, difference ×10; %.2f dB, dE ITP %.3g", subject->comparison.psnr[l].real,
			        subject->comparison.itp[l]);
		fputs("</figcaption></figure>", out);
	}
	fputs("</div>", out);
	return status;
}

/* The plane theta_h x theta_d at one phi_d, theta_h to the right as on the lattice, theta_d upwards; by its 90th percentile. */
static bp_status slice_write(FILE *out, const struct subject *subject, uint32_t k, bp_error *error)
{
	const struct expansion *table = &subject->table;
	const uint32_t width = table->dims.theta_h, height = table->dims.theta_d;
	const size_t pixels = (size_t)width * height;
	const double degrees = (k + 0.5) * 180 / table->dims.phi_d;
	struct picture picture = {0};
	char alt[512];
	double *mean = malloc(pixels * sizeof *mean);
	bp_status status = mean ? picture_alloc(width, height, &picture, error) : error_memory(error, pixels * sizeof *mean);
	if (status == BP_OK) {
		for (size_t n = 0; n < pixels; n++) {
			const size_t cell = lattice_index(table->dims, (uint32_t)(n % width), (uint32_t)(n / width), k);
			mean[n] = (double)((table->rgb[0][cell] + table->rgb[1][cell] + table->rgb[2][cell]) / 3);
		}
		const double white = fmax(1e-30, select_kth(mean, pixels, (size_t)(0.9 * (double)pixels))) / 0.9;
		for (size_t n = 0; n < pixels; n++) {
			const uint32_t i = (uint32_t)(n % width), j = height - 1 - (uint32_t)(n / width);
			for (int c = 0; c < 3; c++)
				picture.rgb[3 * n + (size_t)c] =
					(uint8_t)(255 * image_srgb((double)table->rgb[c][lattice_index(table->dims, i, j, k)] / white) + 0.5);
		}
		snprintf(alt, sizeof alt, "slice of %s at phi_d %.1f degrees; white is %.3g per steradian", subject->head.name, degrees,
		         white * table->unit);
		fputs("<figure>", out);
		status = html_picture(out, &picture, "slice", alt, error);
		fprintf(out, "<figcaption>θ<sub>h</sub> → (square root), θ<sub>d</sub> ↑, at φ<sub>d</sub> = %.1f°</figcaption></figure>",
		        degrees);
	}
	picture_free(&picture);
	free(mean);
	return status;
}

static void layers_write(FILE *out, const struct subject *subject)
{
	const struct record_head *head = &subject->head;
	html_table(out, "Layers: what loading up to each costs, and the error that is left", "layer", "bytes", "log RMSE",
	           "below the horizon too", "cube-root RMSE", "largest relative error", NULL);
	fputs("</tr></thead><tbody>", out);
	for (uint32_t l = 0; l < head->layer_count; l++)
		fprintf(out, "<tr><th scope=row>%u<td>%u<td>%.5f<td>%.5f<td>%.5f<td>%.3g</tr>", l, head->layers[l].bytes,
		        head->layers[l].fidelity.seen_log_rmse, head->layers[l].fidelity.log_rmse,
		        head->layers[l].fidelity.cube_root_rmse, head->layers[l].fidelity.largest_relative);
	fputs("</tbody></table>", out);
}

/* A row: the three numbers, and what they look like beside `white`. */
static void colour_write(FILE *out, const char *what, const double rgb[3], double white)
{
	fprintf(out, "<tr><th scope=row>%s", what);
	for (int c = 0; c < 3; c++)
		fprintf(out, "<td>%.4f", rgb[c]);
	fputs("<td><span class=swatch style=\"background:rgb(", out);
	for (int c = 0; c < 3; c++)
		fprintf(out, "%s%.0f", c ? "," : "", 255 * image_srgb(rgb[c] / white));
	fputs(")\"></span>", out);
}

static void colours_write(FILE *out, const struct subject *subject)
{
	const struct colour_fit *fit = subject->head.colour;
	const double diffuse[3] = {fit[0].diffuse, fit[1].diffuse, fit[2].diffuse},
				 specular[3] = {fit[0].specular, fit[1].specular, fit[2].specular};
	html_table(out, "Parameters of the robust regression", "", "red", "green", "blue", "as colour", NULL);
	fputs("</tr></thead><tbody>", out);
	colour_write(out, "diffuse (1/sr)", diffuse, 1 / M_PI);
	colour_write(out, "specular (ratio)", specular, fmax(1e-30, fmax(specular[0], fmax(specular[1], specular[2]))));
	fputs("</tbody></table>", out);
}

static void source_write(FILE *out, const struct subject *subject)
{
	const struct record_head *head = &subject->head;
	fprintf(out,
	        "<table class=facts><caption>The record and its source</caption><tbody>"
	        "<tr><th scope=row>profile<td>%s, codec version %u"
	        "<tr><th scope=row>lattice<td>%u × %u × %u cells"
	        "<tr><th scope=row>record<td>%u bytes, of which %u are its head"
	        "<tr><th scope=row>made with<td>",
	        profile_name(head->profile), head->codec_version, head->dims.theta_h, head->dims.theta_d, head->dims.phi_d,
	        head->record_bytes, head->head_bytes);
	char holes[80] = "";
	if (head->source.hole_count > 0)
		snprintf(holes, sizeof holes, ", %u taken as not measured for the value they hold", head->source.hole_count);
	if (head->options.max_error > 0)
		fprintf(out, "a log RMSE of at most %g", head->options.max_error);
	else
		fprintf(out, "a budget of %u bytes", head->options.budget_bytes);
	fprintf(out,
	        ", effort %d"
	        "<tr><th scope=row>measured file<td>%llu bytes, %llu cells not finite%s"
	        "<tr><th scope=row>its SHA-256<td><code>",
	        head->options.effort, (unsigned long long)head->source.bytes, (unsigned long long)head->source.nonfinite_count,
	        holes);
	for (int n = 0; n < SHA256_BYTES; n++)
		fprintf(out, "%02x%s", head->source.sha256[n], n % 8 == 7 ? "<wbr>" : "");
	fprintf(out, "</code><tr><th scope=row>measured down to<td>%.2f° below the horizon</tbody></table>",
	        -asin(head->horizon_limit) * 180 / M_PI);
}

static bp_status details_write(FILE *out, const struct subject *subject, bp_error *error)
{
	const uint32_t half = subject->head.dims.phi_d / 2;
	struct table *table;
	fprintf(out, "<section class=material id=m%llu data-index=%llu><h3>", (unsigned long long)subject->item->entry.ordinal,
	        (unsigned long long)subject->item->entry.ordinal);
	html_name(out, subject->head.name);
	fputs("</h3>", out);
	if (subject->missing[0]) {
		fputs("<p class=warning>", out);
		html_text(out, subject->missing);
		fputs("</p>", out);
	}
	bp_status status = spheres_write(out, subject, error);
	if (status == BP_OK)
		status = table_build(&subject->table, TABLE_EXPANDED, 3, &table, error);
	if (status != BP_OK)
		return status;
	fputs("<div class=plots>", out);
	plot_polar(out, table);
	plot_albedo(out, &subject->energy);
	table_free(table);
	fputs("<div class=slices>", out);
	status = slice_write(out, subject, half, error);
	if (status == BP_OK)
		status = slice_write(out, subject, 0, error);
	fputs("</div></div><div class=tables>", out);
	layers_write(out, subject);
	colours_write(out, subject);
	source_write(out, subject);
	fputs("</div><p><a href=\"#sheet\">back to the contact sheet</a></p></section>\n", out);
	return status;
}

static void result_fill(const struct subject *subject, struct page_result *result)
{
	result->record_bytes = subject->head.record_bytes;
	result->layer_count = subject->head.layer_count;
	for (uint32_t l = 0; l < subject->head.layer_count; l++) {
		result->layer_bytes[l] = subject->head.layers[l].bytes;
		result->layer_error[l] = subject->head.layers[l].fidelity.seen_log_rmse;
	}
	result->albedo = subject->energy.largest;
	result->measured = subject->measured;
	for (int l = 0; subject->measured && l < LIGHTING_COUNT; l++)
		result->psnr[l] = subject->comparison.psnr[l].real;
}

bp_status page_work(void *user, const struct job *job, int fd, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	struct page_job *page = user;
	struct subject subject = {.item = &page->items[job->number]};
	struct page_result result;
	struct byte_buffer text = {0};
	FILE *out = NULL;

	(void)fd;
	memset(&result, 0, sizeof result); /* padding too: it travels between processes as bytes */
	if (page->measured && !subject.item->source)
		snprintf(subject.missing, sizeof subject.missing, "not compared: there is no measured file of that name");
	bp_status status = archive_entry_head(page->archive, &subject.item->entry, &subject.head, error);
	if (status == BP_OK)
		status = archive_entry_expand(page->archive, &subject.item->entry, &subject.head, 0, &subject.table, error);
	if (status == BP_OK)
		status = subject.item->source ? measured_draw(page, &subject, error) : decoded_draw(page, &subject, error);
	if (status != BP_OK)
		goto out;
	result_fill(&subject, &result);
	write_zeros(&text, sizeof result);
	out = memory_stream_open(&text);
	if (!out) {
		status = error_memory(error, sizeof result);
		goto out;
	}
	status = sheet_write(out, page, &subject, error);
	fflush(out);
	result.sheet_bytes = (uint32_t)(text.count - sizeof result);
	if (status == BP_OK && page->details)
		status = details_write(out, &subject, error);
	fclose(out);
	result.details_bytes = (uint32_t)(text.count - sizeof result - result.sheet_bytes);
	if (status == BP_OK && !text.failed)
		memcpy(text.bytes, &result, sizeof result);
	if (status == BP_OK)
		status = workers_deliver(&text, record, record_bytes, error);
out:
	byte_buffer_free(&text);
	subject_free(&subject);
	return status;
}
