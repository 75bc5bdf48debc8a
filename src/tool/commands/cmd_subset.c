#include "tool/command.h"
#include "tool/interrupt.h"
#include "tool/options.h"
#include "tool/output_check.h"
#include "tool/report.h"
#include "tool/scene.h"
#include "tool/selection.h"

#include "archive/merge.h"
#include "error.h"
#include "merl/normal_form.h"
#include "merl/source_kind.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

struct subset {
	struct copy_options copy;
	bool quiet, force;
	bool lacking; /* a scene names a material that the archive has not, or has in another Unicode form */
	struct scene_words words;
	size_t scene_count;
	const char **inputs; /* the archive, then the scenes: for the output's check */
	struct selection selection;
};

static int ascending(const void *a, const void *b)
{
	uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
	return (x > y) - (x < y);
}

static void word_missing(struct subset *subset, size_t number)
{
	const struct scene_word *word = &subset->words.word[number];
	selection_missing_report(&subset->selection, word->text, word->file);
	subset->lacking = true;
}

/* Names of scenes that are there in another Unicode form only. */
static void other_forms_report(struct subset *subset, struct normal_forms *forms)
{
	bp_archive *archive = subset->selection.archive;
	struct index_page leaf = {0};
	struct index_entry entry;
	size_t number;
	for (uint64_t n = 0; forms->count > 0 && n < bp_archive_count(archive); n++) {
		if (archive_entry(archive, n, &leaf, &entry, NULL))
			return; /* copying will say why */
		if (normal_forms_find(forms, entry.name, &number))
			word_missing(subset, number);
	}
}

/* Adds the materials whose names, or measured files, are among the scenes' words. Files that are not there are told. */
static bool scenes_find(struct subset *subset)
{
	struct selection *selection = &subset->selection;
	struct normal_forms forms = {0};
	char name[BP_NAME_BYTES_MAX + 1];
	bp_error error;
	bp_status status = BP_OK;
	for (size_t n = 0; n < subset->words.count; n++) {
		const struct scene_word *word = &subset->words.word[n];
		status = selection_name_find(selection->archive, word->text, &selection->index[selection->count], &error);
		if (!status) {
			selection->count++;
		} else if (status != BP_ERROR_NOT_FOUND) {
			report_error(selection->path, word->text, &error);
			break;
		} else if (source_suffix_bytes(word->text) && !word->spare) {
			word_missing(subset, n);
		} else if (!word->spare && selection_name_bare(word->text, name)) {
			normal_forms_add(&forms, name, n);
		}
		status = BP_OK;
	}
	if (!status)
		other_forms_report(subset, &forms);
	normal_forms_free(&forms);
	return !status;
}

/* Makes the selection those named and those the scenes name, each once, in the archive's order; or leaves it at all. */
static bool materials_choose(struct subset *subset)
{
	struct selection *selection = &subset->selection;
	if (selection->all && subset->scene_count == 0)
		return true;
	const size_t named = selection->all ? 0 : (size_t)selection->count, room = named + subset->words.count + 1;
	uint64_t *index = realloc(selection->index, room * sizeof *index), kept = 0;
	if (!index) {
		bp_error error;
		error_memory(&error, room * sizeof *index);
		report_error(selection->path, NULL, &error);
		return false;
	}
	selection->index = index;
	selection->count = named;
	selection->all = false;
	if (!scenes_find(subset))
		return false;
	if (selection->count == 0) {
		report_text("%s: no material's name stands between quotes in the scene files; not written", selection->path);
		return false;
	}
	qsort(index, selection->count, sizeof *index, ascending);
	for (uint64_t n = 0; n < selection->count; n++)
		if (kept == 0 || index[kept - 1] != index[n])
			index[kept++] = index[n];
	selection->count = kept;
	return true;
}

static int subset_write(struct subset *subset)
{
	const struct selection *selection = &subset->selection;
	struct copy_totals totals = {0};
	bp_error error;

	if (interrupt_install(NULL, &error) ||
	    archive_subset(selection->archive, selection->index, selection->count, &subset->copy, &totals, &error))
		return report_error(totals.reading ? selection->path : subset->copy.output, totals.damaged[0] ? totals.damaged : NULL,
		                    &error);
	if (totals.stopped)
		return interrupt_exit(subset->copy.output);
	if (!subset->quiet) {
		report_remark(subset->copy.output, &error);
		text_print(subset->copy.output, 0);
		printf(": %" PRIu64 " material%s, %" PRIu64 " of %" PRIu64 " bytes of their records\n", totals.copied,
		       totals.copied == 1 ? "" : "s", totals.bytes_to, totals.bytes_from);
	}
	return subset->lacking ? EXIT_FAILED : EXIT_OK;
}

/* With everything that is allocated in *subset; the caller frees it. */
static int subset_run(struct subset *subset, char **names, int name_count)
{
	const char *const path = subset->inputs[0];
	bp_error error;

	if (!output_check(subset->copy.output, OUTPUT_KIND_ARCHIVE, subset->force, subset->inputs, 1 + subset->scene_count))
		return EXIT_FAILED;
	for (size_t n = 1; n <= subset->scene_count; n++)
		if (scene_words_add(&subset->words, subset->inputs[n], &error))
			return report_error(subset->inputs[n], NULL, &error);
	scene_words_sort(&subset->words);
	if (!selection_open(&subset->selection, path, names, name_count) || subset->selection.incomplete || !materials_choose(subset))
		return EXIT_FAILED;
	return subset_write(subset);
}

static bool scene_take(const struct command *self, const struct option_rule *rule, const char *text)
{
	struct subset *subset = rule->to;
	(void)self;
	subset->inputs[++subset->scene_count] = text;
	return true;
}

static int subset_main(const struct command *self, int argc, char **argv)
{
	struct subset subset = {.copy = {.stop = interrupt_came}, .inputs = calloc((size_t)argc + 1, sizeof *subset.inputs)};
	const struct option_rule rules[] = {{"output", 'o', option_output, .to = &subset.copy.output},
	                                    {"quiet", 'q', option_flag, .to = &subset.quiet},
	                                    {"max-error", 0, option_number, &subset.copy.max_log_rmse, 1e-6, 10},
	                                    {"scene", 0, scene_take, .to = &subset},
	                                    {"force", 0, option_flag, .to = &subset.force},
	                                    {0}};

	if (!subset.inputs)
		return report_text("out of memory");
	int code = options_read(self, argc, argv, rules);
	if (code == OPTIONS_END && optind >= argc)
		code = report_usage(self, "no archive");
	if (code == OPTIONS_END) {
		subset.inputs[0] = argv[optind];
		code = subset_run(&subset, argv + optind + 1, argc - optind - 1);
	}
	free(subset.inputs);
	selection_close(&subset.selection);
	scene_words_free(&subset.words);
	return code;
}

const struct command command_subset = {
	.name = "subset",
	.run = subset_main,
	.description = "copy materials to a smaller archive, without re-encoding",
	.usage = "Usage: brdfpack subset -o SCENE.bpk [OPTION]... ARCHIVE [NAME]...\n"
			 "Copies the named materials, those that scene files name, or all. Records are copied byte\n"
			 "for byte, but for layers that are left out.\n"
			 "\n"
			 "  -o, --output SCENE.bpk  the new archive; replaces an older one that is not the input\n"
			 "      --force             also the input, or a file that is no archive\n"
			 "      --max-error E       keep the fewest layers whose log RMSE over what can be seen,\n"
			 "                          as `list` shows it, is at most E; all where there is none\n"
			 "      --scene FILE        also the materials whose name, or measured file, stands between\n"
			 "                          quotes in FILE (pbrt, Mitsuba XML, USD ASCII, JSON); may be given\n"
			 "                          repeatedly\n"
			 "  -q, --quiet             say nothing on success\n"
			 "  -h, --help              this text\n"
			 "\n"
			 "When a NAME is not there, nothing is written and the exit code is 1. A measured file that a\n"
			 "scene names and the archive has not is told, the others are copied, and the exit code is 1.\n",
};
