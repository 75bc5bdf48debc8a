#include "tool/command.h"
#include "tool/interrupt.h"
#include "tool/material_name.h"
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
	const char *path; /* of the archive */
	struct copy_options copy;
	bool quiet, force;
	bool lacking; /* a scene names a material that the archive has not, or has in another Unicode form */
	struct scene_words words;
	size_t scene_count;
	const char **inputs; /* the archive, then the scenes: for the output's check */
	bp_archive *archive;
	uint64_t *index; /* of the materials wanted, ascending; NULL: all */
	uint64_t count;
};

static int ascending(const void *a, const void *b)
{
	uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
	return (x > y) - (x < y);
}

/* Names of scenes that are there in another Unicode form only. */
static void other_forms_report(struct subset *subset, struct selection *selection, struct normal_forms *forms)
{
	struct index_page leaf = {0};
	struct index_entry entry;
	size_t number;
	for (uint64_t n = 0; forms->count > 0 && n < bp_archive_count(selection->archive); n++) {
		if (archive_entry(selection->archive, n, &leaf, &entry, NULL))
			return; /* copying will say why */
		if (normal_forms_find(forms, entry.name, &number)) {
			selection_missing_report(selection, subset->words.word[number].text, subset->words.word[number].file);
			subset->lacking = true;
		}
	}
}

/* Adds the materials whose names, or measured files, are among the scenes' words. Files that are not there are told. */
static bool scenes_find(struct subset *subset, struct selection *selection)
{
	struct normal_forms forms = {0};
	char name[BP_NAME_BYTES_MAX + 1];
	bp_error error;
	bp_status status = BP_OK;
	for (size_t n = 0; n < subset->words.count; n++) {
		const struct scene_word *word = &subset->words.word[n];
		status = material_name_find(selection->archive, word->text, &subset->index[subset->count], &error);
		if (!status) {
			subset->count++;
		} else if (status != BP_ERROR_NOT_FOUND) {
			report_error(subset->path, word->text, &error);
			break;
		} else if (source_suffix_bytes(word->text) && !word->spare) {
			selection_missing_report(selection, word->text, word->file);
			subset->lacking = true;
		} else if (!word->spare && material_name_bare(word->text, name)) {
			normal_forms_add(&forms, name, n);
		}
		status = BP_OK;
	}
	if (!status)
		other_forms_report(subset, selection, &forms);
	normal_forms_free(&forms);
	return !status;
}

/* Which materials: those named and those the scenes name, each once, in the archive's order. */
static bool materials_choose(struct subset *subset, struct selection *selection, int name_count)
{
	bp_error error;
	size_t room = (size_t)name_count + subset->words.count;
	if (name_count == 0 && subset->scene_count == 0) {
		subset->count = selection->count;
		return true;
	}
	subset->index = malloc((room ? room : 1) * sizeof *subset->index);
	if (!subset->index) {
		error_memory(&error, room * sizeof *subset->index);
		report_error(subset->path, NULL, &error);
		return false;
	}
	for (uint64_t n = 0; name_count > 0 && n < selection->count; n++)
		subset->index[subset->count++] = selection->index[n];
	if (!scenes_find(subset, selection))
		return false;
	if (subset->count == 0) {
		report_text("%s: no material's name stands between quotes in the scene files; not written", subset->path);
		return false;
	}
	uint64_t kept = 0;
	qsort(subset->index, subset->count, sizeof *subset->index, ascending);
	for (uint64_t n = 0; n < subset->count; n++)
		if (kept == 0 || subset->index[kept - 1] != subset->index[n])
			subset->index[kept++] = subset->index[n];
	subset->count = kept;
	return true;
}

static int subset_write(struct subset *subset)
{
	struct copy_totals totals = {0};
	bp_error error;

	if (interrupt_install(NULL, &error) ||
	    archive_subset(subset->archive, subset->index, subset->count, &subset->copy, &totals, &error)) {
		report_error(totals.reading ? subset->path : subset->copy.output, totals.damaged[0] ? totals.damaged : NULL, &error);
		return EXIT_FAILED;
	}
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
	struct selection selection;
	int result = EXIT_FAILED;
	bp_error error;

	if (!output_check(subset->copy.output, OUTPUT_KIND_ARCHIVE, subset->force, subset->inputs, 1 + subset->scene_count))
		return EXIT_FAILED;
	for (size_t n = 1; n <= subset->scene_count; n++)
		if (scene_words_add(&subset->words, subset->inputs[n], &error)) {
			report_error(subset->inputs[n], NULL, &error);
			return EXIT_FAILED;
		}
	scene_words_sort(&subset->words);
	if (selection_open(&selection, subset->path, names, name_count)) {
		subset->archive = selection.archive;
		if (!selection.incomplete && materials_choose(subset, &selection, name_count))
			result = subset_write(subset);
		selection_close(&selection);
	}
	return result;
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
	const struct option_rule rules[] = {{"output", 'o', option_text, .to = &subset.copy.output},
	                                    {"quiet", 'q', option_flag, .to = &subset.quiet},
	                                    {"max-error", 0, option_number, &subset.copy.max_log_rmse, 1e-6, 10},
	                                    {"scene", 0, scene_take, .to = &subset},
	                                    {"force", 0, option_flag, .to = &subset.force},
	                                    {0}};

	if (!subset.inputs) {
		report_text("out of memory");
		return EXIT_FAILED;
	}
	int code = options_read(self, argc, argv, rules);
	if (code == OPTIONS_END && !option_output(self, subset.copy.output, "SCENE.bpk"))
		code = EXIT_USAGE;
	if (code == OPTIONS_END && optind >= argc)
		code = report_usage(self, "no archive");
	if (code == OPTIONS_END) {
		subset.path = subset.inputs[0] = argv[optind];
		code = subset_run(&subset, argv + optind + 1, argc - optind - 1);
	}
	free(subset.inputs);
	free(subset.index);
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
