#include "tool/command.h"
#include "tool/facts.h"
#include "tool/options.h"
#include "tool/report.h"
#include "tool/selection.h"

#include "merl/sha256.h"
#include "shown.h"

#include <inttypes.h>
#include <math.h>

struct totals {
	uint64_t materials, record_bytes, source_bytes, failed;
};

/* A first walk over the names alone, which stand in the index, so that the table is aligned without keeping it. */
static int widest_name(struct selection *selection)
{
	struct index_entry entry;
	int widest = 8; /* "material" */
	for (uint64_t i = 0; i < selection->count && !selection_entry(selection, i, &entry, NULL); i++)
		if (shown_columns(entry.name) > widest)
			widest = shown_columns(entry.name);
	return widest;
}

/* A number in nine columns: plain where four decimals say enough, else in powers of ten. */
static void number_print(double value)
{
	double size = fabs(value);
	printf(size == 0 || (size >= 5e-4 && size < 9999) ? " %9.4f" : " %9.2e", value);
}

static void row_print(const struct record_head *head, int width)
{
	text_print(head->name, width);
	printf(" %9" PRIu32 "  %-8s %6" PRIu32 "  %8.5f ", head->record_bytes, profile_name(head->profile), head->layer_count,
	       head_fidelity(head)->seen_log_rmse);
	for (int c = 0; c < 3; c++)
		number_print(head->colour[c].diffuse);
	putchar(' ');
	for (int c = 0; c < 3; c++)
		number_print(head->colour[c].specular);
	putchar('\n');
}

/* What a section holds. The first types are the paper's profile's: four for each channel, from SECTION_MARGINALS on. */
static const char *section_name(unsigned type)
{
	static const char *const NAMES[SECTION_ORIGIN + 1] = {"other",
	                                                      "marginals, R",
	                                                      "c_hd, R",
	                                                      "c_hphi, R",
	                                                      "c_dphi|h, R",
	                                                      "marginals, G",
	                                                      "c_hd, G",
	                                                      "c_hphi, G",
	                                                      "c_dphi|h, G",
	                                                      "marginals, B",
	                                                      "c_hd, B",
	                                                      "c_hphi, B",
	                                                      "c_dphi|h, B",
	                                                      [SECTION_FIELDS] = "fields",
	                                                      [SECTION_PLANES] = "bit planes",
	                                                      [SECTION_ORIGIN] = "origin"};
	return type <= SECTION_ORIGIN && NAMES[type] ? NAMES[type] : "other";
}

/* What kind of file the source was, unless it was a MERL table. */
static void origin_print(const struct origin *origin)
{
	if (!origin_text(origin->kind))
		return;
	printf("              %s", origin_text(origin->kind));
	if (origin->kind == ORIGIN_RGL_SPECTRA)
		printf(" (%" PRIu32 " wavelengths, %g to %g nm), made linear RGB: CIE 1931 2 degrees, D65, ITU-R BT.709",
		       origin->wavelengths, origin->first_nm, origin->last_nm);
	printf(
		"\n              made reciprocal: the two directions differed by %.1f %% in the median, %.1f %% in the 95th percentile\n",
		100 * origin->median, 100 * origin->percentile95);
}

/* Everything about one material. */
static void material_print(const struct record_head *head, const struct origin *origin)
{
	char sha256[SHA256_HEX_CHARACTERS + 1];
	sha256_to_hex(head->source.sha256, sha256);
	text_print(head->name, 0);
	putchar('\n');
	printf("  record      %" PRIu32 " bytes, profile %s, ", head->record_bytes, profile_name(head->profile));
	if (head->codec_version == RECORD_LAYERS_DROPPED)
		printf("layers dropped, ");
	else
		printf("codec version %" PRIu32 ", ", head->codec_version);
	if (head->options.max_error > 0)
		printf("made for log RMSE <= %g", head->options.max_error);
	else
		printf("made for at most %" PRIu32 " bytes", head->options.budget_bytes);
	printf(", effort %d\n", head->options.effort);
	printf("  source      %" PRIu64 " bytes, SHA-256 %s\n", head->source.bytes, sha256);
	printf("              %" PRIu64 " cells NaN or infinite\n", head->source.nonfinite_count);
	if (head->source.hole_count > 0 || head->options.zeros != ZEROS_AUTO)
		printf("              %" PRIu32 " cells taken as not measured for the value they hold (--zeros=%s)\n",
		       head->source.hole_count, ZEROS_NAMES[head->options.zeros]);
	origin_print(origin);
	printf("  lattice     %" PRIu32 " x %" PRIu32 " x %" PRIu32 " (theta_h, theta_d, phi_d), measured down to cosine %.4f\n",
	       head->dims.theta_h, head->dims.theta_d, head->dims.phi_d, head->horizon_limit);
	for (uint32_t i = 0; i < head->layer_count; i++) {
		const struct record_layer *layer = &head->layers[i];
		printf("  layer %-3" PRIu32 "   %8" PRIu32
		       " bytes so far  log RMSE %.6f, of what is seen %.6f  cube-root RMSE %.6f  largest relative error %.4g\n",
		       i, layer->bytes, layer->fidelity.log_rmse, layer->fidelity.seen_log_rmse, layer->fidelity.cube_root_rmse,
		       layer->fidelity.largest_relative);
	}
	for (uint32_t i = 0; i < head->section_count; i++) {
		const struct record_section *section = &head->sections[i];
		printf("  section %-3" PRIu32 " %8" PRIu32 " bytes  layer %u  type %u (%s)  codec %u.%u", i, section->bytes,
		       section->layer, section->type, section_name(section->type), section->codec, section->version);
		if (section->error == section->error)
			printf("  error %.6g", section->error);
		putchar('\n');
	}
	for (int c = 0; c < 3; c++) {
		const struct colour_fit *fit = &head->colour[c];
		printf("  %-6s      diffuse %.6g  specular %.6g  %" PRIu32 " iterations, %s, %.2f %% of the cells rejected\n",
		       CHANNEL_NAMES[c], fit->diffuse, fit->specular, fit->iterations, fit->converged ? "converged" : "not converged",
		       100 * fit->rejected);
	}
	printf("  left out   ");
	for (int pair = 0; pair < 3; pair++)
		if (head->left_out >> pair & 1)
			printf(" %s", PAIR_NAMES[pair]);
	printf("%s\n", head->left_out ? "" : " no pair");
}

static void totals_json(const struct selection *selection, const struct totals *totals, const char *sha256)
{
	struct json json = json_begin(stdout, false);
	json_bool(&json, "summary", true);
	json_string(&json, "archive", selection->path);
	json_integer(&json, "materials", totals->materials);
	json_integer(&json, "bytes", totals->record_bytes);
	json_integer(&json, "source_bytes", totals->source_bytes);
	if (sha256[0])
		json_string(&json, "sha256", sha256);
	json_finish(&json);
}

static void totals_print(const struct totals *totals)
{
	printf("%" PRIu64 " material%s, %" PRIu64 " bytes of records", totals->materials, totals->materials == 1 ? "" : "s",
	       totals->record_bytes);
	if (totals->source_bytes > 0) /* what a program packed from memory has no file behind it */
		printf(", made from %" PRIu64 " bytes (1/%.0f)", totals->source_bytes,
		       (double)totals->source_bytes / (double)totals->record_bytes);
	putchar('\n');
}

static int list_main(const struct command *self, int argc, char **argv)
{
	struct selection selection;
	struct totals totals = {0};
	bool json = false, digest = false;
	int width = 0;
	const struct option_rule rules[] = {{"json", 0, option_flag, .to = &json}, {"sha256", 0, option_flag, .to = &digest}, {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	code = selection_from(&selection, self, argv + optind, argc - optind);
	if (code != EXIT_OK)
		return code;
	if (selection.all && !json) {
		width = widest_name(&selection);
		printf("%-*s %9s  %-8s %6s  %8s   %-29s   %s\n", width, "material", "bytes", "profile", "layers", "log RMSE",
		       "diffuse R, G, B (1/sr)", "specular R, G, B");
	}
	for (uint64_t i = 0; i < selection.count && !ferror(stdout); i++) {
		struct index_entry entry;
		struct record_head head;
		if (!selection_head(&selection, i, &entry, &head)) {
			totals.failed++;
			continue;
		}
		struct origin origin = {.kind = ORIGIN_MERL};
		bp_error fault;
		if ((json || !selection.all) && archive_entry_origin(selection.archive, &entry, &head, &origin, &fault)) {
			report_error(selection.path, entry.name, &fault);
			totals.failed++;
		}
		if (json)
			facts_print(stdout, false, &head, &origin);
		else if (selection.all)
			row_print(&head, width);
		else
			material_print(&head, &origin);
		totals.materials++;
		totals.record_bytes += head.record_bytes;
		totals.source_bytes += head.source.bytes;
	}
	char sha256[SHA256_HEX_CHARACTERS + 1] = "";
	bp_error error;
	if (digest && sha256_of_file(selection.path, sha256, &error)) {
		report_error(selection.path, NULL, &error);
		totals.failed++;
	}
	if (json)
		totals_json(&selection, &totals, sha256);
	else if (selection.all)
		totals_print(&totals);
	if (sha256[0] && !json)
		printf("SHA-256 %s\n", sha256);
	bool whole = totals.failed == 0 && !selection.incomplete;
	selection_close(&selection);
	return whole ? EXIT_OK : EXIT_FAILED;
}

const struct command command_list = {
	.name = "list",
	.run = list_main,
	.description = "show what is in an archive",
	.usage = "Usage: brdfpack list [OPTION]... ARCHIVE [NAME]...\n"
			 "Prints one row per material, and totals. With names: everything about these materials.\n"
			 "\n"
			 "      --sha256  also the SHA-256 of the whole file, to sign or to compare; reads all of it\n"
			 "      --json    one JSON object per material, then a summary object\n"
			 "  -h, --help    this text\n",
};
