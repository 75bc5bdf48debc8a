#include "build_report.h"

#include "tool/facts.h"
#include "tool/json.h"
#include "tool/report.h"

#include <inttypes.h>
#include <stdio.h>

enum { WARNINGS_MAX = 4, WARNING_BYTES = 400 };
static const char *const ORIGIN_NAMES[] = {
	[RECORD_FITTED] = "fitted", [RECORD_REUSED] = "reused", [RECORD_RESUMED] = "resumed", [RECORD_KEPT] = "kept"};

/* The warning that values were taken for marks. */
static void holes_describe(const struct outcome *outcome, char text[WARNING_BYTES])
{
	const struct holes *holes = &outcome->delivery.holes;
	const double *v = holes->value;
	char what[100], black[120] = "";

	if (v[0] == 0 && v[1] == 0 && v[2] == 0)
		snprintf(what, sizeof what, "0 in all channels");
	else
		snprintf(what, sizeof what, "%.3g, %.3g, %.3g /sr", v[0], v[1], v[2]);
	if (holes->black_count > 0)
		snprintf(black, sizeof black, "; %zu that are 0 above the horizon stay black (--zeros=holes if they are holes too)",
		         holes->black_count);
	if (outcome->head.options.zeros == ZEROS_HOLES)
		snprintf(text, WARNING_BYTES, "%zu cells that are 0 in all channels are treated as not measured (--zeros=holes)",
		         holes->count);
	else
		snprintf(
			text, WARNING_BYTES,
			"no value is negative, and %zu cells below the horizon are %s: treated as not measured (unless --zeros=measured)%s",
			holes->count, what, black);
}

/* What is odd about a material that was packed nevertheless; the first `*said` are faults of the file, the rest is in --json. */
static int warnings_list(const struct outcome *outcome, char texts[WARNINGS_MAX][WARNING_BYTES], int *said)
{
	int count = 0;
	if (outcome->delivery.source.nonfinite_count > 0)
		snprintf(texts[count++], WARNING_BYTES, "%" PRIu64 " cells are NaN or infinite; they are treated as not measured",
		         outcome->delivery.source.nonfinite_count);
	if (outcome->delivery.holes.count > 0)
		holes_describe(outcome, texts[count++]);
	if (outcome->delivery.black)
		snprintf(texts[count++], WARNING_BYTES, "every value is 0: it reflects no light at all; is the file what it should be?");
	*said = count;
	for (int c = 0; c < 3; c++)
		if (!outcome->head.colour[c].converged) {
			snprintf(texts[count++], WARNING_BYTES, "the colour regression did not converge in %" PRIu32 " iterations (%s)",
			         outcome->head.colour[c].iterations, CHANNEL_NAMES[c]);
			break;
		}
	return count;
}

void report_unpacked(const char *label, const char *name, const bp_error *error, bool json)
{
	if (json) {
		struct json line = json_begin(stdout, false);
		char text[1024];
		error_describe(error, text, sizeof text);
		if (name)
			json_string(&line, "name", name);
		json_string(&line, "path", label);
		json_string(&line, "error", text);
		json_finish(&line);
		fflush(stdout);
	}
	report_error(label, name, error);
}

void report_passed_over(const char *path, const char *reason, bool json, bool quiet)
{
	if (json) {
		struct json line = json_begin(stdout, false);
		json_string(&line, "path", path);
		json_string(&line, "warning", reason);
		json_finish(&line);
	}
	if (!quiet)
		report_warning(path, NULL, "%s; skipped", reason);
}

static void material_json(const struct item *item, const char *label, const struct outcome *outcome)
{
	struct json json = json_begin(stdout, false);
	json_string(&json, "name", item->source.name);
	json_string(&json, "path", label);
	char warnings[WARNINGS_MAX][WARNING_BYTES];
	int said, count = warnings_list(outcome, warnings, &said);
	json_integer(&json, "bytes", outcome->head.record_bytes);
	json_number(&json, "seconds", outcome->seconds);
	json_object(&json, "cpu_seconds");
	for (int stage = 0; stage < STAGE_COUNT; stage++)
		json_number(&json, stage_name((enum stage)stage), outcome->stage_seconds[stage]);
	json_close(&json);
	json_string(&json, "record", ORIGIN_NAMES[outcome->delivery.origin]);
	json_string(&json, "profile", profile_name(outcome->head.profile));
	facts_brief(&json, &outcome->head);
	json_array(&json, "warnings");
	for (int i = 0; i < count; i++)
		json_string(&json, NULL, warnings[i]);
	json_close(&json);
	json_finish(&json);
	fflush(stdout); /* a line per material as it is done: someone may be watching */
}

void report_material(const struct item *item, const struct outcome *outcome, bool json, bool quiet)
{
	char label[ITEM_LABEL_BYTES];
	item_label(&item->source, label);
	if (outcome->error.status) {
		report_unpacked(label, item->source.name, &outcome->error, json);
		return;
	}
	if (json)
		material_json(item, label, outcome);
	char warnings[WARNINGS_MAX][WARNING_BYTES];
	int said;
	warnings_list(outcome, warnings, &said);
	for (int i = 0; i < said && !quiet; i++)
		report_warning(label, item->source.name, "%s", warnings[i]);
}

static void summary_json(const char *output, bool written, const struct build_totals *totals, const struct source_list *sources)
{
	struct json json = json_begin(stdout, false);
	json_bool(&json, "summary", true);
	json_string(&json, "archive", output);
	json_bool(&json, "written", written);
	json_integer(&json, "materials", totals->packed);
	json_integer(&json, "reused", totals->reused);
	json_integer(&json, "kept", totals->kept);
	json_integer(&json, "refused", totals->refused);
	json_integer(&json, "missing", totals->missing);
	json_integer(&json, "damaged_inputs", totals->damaged);
	json_integer(&json, "skipped_inputs", totals->skipped);
	json_integer(&json, "ignored_files", sources->ignored_count);
	json_array(&json, "licence_texts");
	for (size_t n = 0; n < sources->licences.count; n++)
		json_string(&json, NULL, sources->licences.path[n]);
	json_close(&json);
	json_integer(&json, "source_bytes", totals->source_bytes);
	json_integer(&json, "bytes", totals->archive_bytes);
	json_number(&json, "seconds", totals->seconds);
	json_finish(&json);
}

/* Files that are no materials, in one line: nothing is wrong, but a licence's text among them concerns who uses the archive. */
static void ignored_report(const struct source_list *sources)
{
	char names[1024] = "";
	size_t used = 0;
	for (size_t n = 0; n < sources->licences.count && used < sizeof names; n++)
		used += (size_t)snprintf(names + used, sizeof names - used, "%s%s",
		                         n                             ? ", "
		                         : sources->licences.count > 1 ? "; texts of licences: "
		                                                       : "; the text of a licence: ",
		                         sources->licences.path[n]);
	report_text("%zu other file%s passed over%s", sources->ignored_count, sources->ignored_count == 1 ? "" : "s", names);
}

void report_summary(const struct build_options *options, bool written, bool stopped, const struct build_totals *totals,
                    const struct source_list *sources)
{
	const char *output = options->output;
	if (options->json)
		summary_json(output, written, totals, sources);
	if (written && !options->quiet && sources->ignored_count > 0)
		ignored_report(sources);
	if (written && totals_whole(totals))
		return;
	if (stopped) { /* how far the workers came is chance: no counts */
		report_text("%s: not written%s", output, options->strict && totals->refused > 0 ? " (--strict)" : "");
		return;
	}
	char damaged[64] = "";
	if (totals->damaged > 0)
		snprintf(damaged, sizeof damaged, ", %" PRIu64 " input%s with errors", totals->damaged, totals->damaged == 1 ? "" : "s");
	report_text("%s: %s: %" PRIu64 " packed, %" PRIu64 " refused, %" PRIu64 " missing%s", output,
	            written ? "written without some materials" : "not written", totals->packed, totals->refused, totals->missing,
	            damaged);
}
