#include "tool/command.h"
#include "tool/interrupt.h"
#include "tool/options.h"
#include "tool/report.h"
#include "tool/scene.h"
#include "tool/selection.h"

#include "archive/merge.h"
#include "error.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

struct subset {
	const char *path; /* of the archive */
	struct copy_options copy;
	bool quiet;
	struct scene_words words;
	size_t scene_count;
	bp_archive *archive;
	uint64_t *index; /* of the materials wanted, ascending; NULL: all */
	uint64_t count;
};

static bool stop(void)
{
	return interrupt_signal() != 0;
}

static int ascending(const void *a, const void *b)
{
	uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
	return (x > y) - (x < y);
}

/* Adds the materials whose names are among the scenes' words. */
static bool scenes_find(struct subset *subset, struct selection *selection)
{
	bp_error error;
	for (size_t n = 0; n < subset->words.count; n++) {
		bp_status status = bp_archive_find(selection->archive, subset->words.word[n], &subset->index[subset->count], &error);
		if (!status) {
			subset->count++;
		} else if (status != BP_ERROR_NOT_FOUND) {
			report_error(subset->path, subset->words.word[n], &error);
			return false;
		}
	}
	return true;
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
	int wake_fd;

	if (interrupt_install(&wake_fd, &error) ||
	    archive_subset(subset->archive, subset->index, subset->count, &subset->copy, &totals, &error)) {
		report_error(totals.reading ? subset->path : subset->copy.output, NULL, &error);
		return EXIT_FAILED;
	}
	if (totals.stopped) {
		report_text("%s: interrupted; not written", subset->copy.output);
		return 128 + interrupt_signal();
	}
	if (!subset->quiet)
		printf("%s: %" PRIu64 " material%s, %" PRIu64 " of %" PRIu64 " bytes of their records\n", subset->copy.output, totals.copied,
		       totals.copied == 1 ? "" : "s", totals.bytes_to, totals.bytes_from);
	return EXIT_OK;
}

static int subset_main(const struct command *self, int argc, char **argv)
{
	enum { OPTION_MAX_ERROR = OPTION_LONG, OPTION_SCENE };
	static const struct option names[] = {{"output", required_argument, NULL, 'o'},
	                                      {"quiet", no_argument, NULL, 'q'},
	                                      {"max-error", required_argument, NULL, OPTION_MAX_ERROR},
	                                      {"scene", required_argument, NULL, OPTION_SCENE},
	                                      {0}};
	struct subset subset = {.copy = {.stop = stop}};
	struct selection selection;
	int option, result = EXIT_FAILED;
	bp_error error;

	while ((option = options_next(self, argc, argv, "o:q", names)) >= 0) {
		if (option == 'o') {
			subset.copy.output = optarg;
		} else if (option == 'q') {
			subset.quiet = true;
		} else if (option == OPTION_MAX_ERROR) {
			if (!option_number(self, "--max-error", optarg, 1e-6, 10, &subset.copy.max_log_rmse)) {
				scene_words_free(&subset.words);
				return EXIT_USAGE;
			}
		} else {
			subset.scene_count++;
			if (scene_words_add(&subset.words, optarg, &error)) {
				report_error(optarg, NULL, &error);
				scene_words_free(&subset.words);
				return EXIT_FAILED;
			}
		}
	}
	if (option != OPTIONS_END || !subset.copy.output || !*subset.copy.output || optind >= argc) {
		scene_words_free(&subset.words);
		if (option != OPTIONS_END)
			return options_exit_code(option);
		return report_usage(self, subset.copy.output && *subset.copy.output ? "no archive" : "no output file; give one with -o SCENE.bpk");
	}
	scene_words_sort(&subset.words);
	subset.path = argv[optind];
	const int name_count = argc - optind - 1;
	if (selection_open(&selection, subset.path, argv + optind + 1, name_count)) {
		subset.archive = selection.archive;
		if (!selection.incomplete && materials_choose(&subset, &selection, name_count))
			result = subset_write(&subset);
		selection_close(&selection);
	}
	free(subset.index);
	scene_words_free(&subset.words);
	return result;
}

const struct command command_subset = {
	.name = "subset",
	.run = subset_main,
	.description = "copy materials to a smaller archive, without re-encoding",
	.usage = "Usage: brdfpack subset -o SCENE.bpk [OPTION]... ARCHIVE [NAME]...\n"
	         "Copies the named materials, those that scene files name, or all. Records are copied byte\n"
	         "for byte, but for layers that are left out.\n"
	         "\n"
	         "  -o, --output SCENE.bpk  the new archive\n"
	         "      --max-error E       keep the fewest layers whose log RMSE is at most E; all where\n"
	         "                          there is none\n"
	         "      --scene FILE        also the materials whose name stands between quotes in FILE\n"
	         "                          (pbrt, Mitsuba XML, USD ASCII, JSON); may be given repeatedly\n"
	         "  -q, --quiet             say nothing on success\n"
	         "  -h, --help              this text\n"
	         "\n"
	         "When a NAME is not there, nothing is written and the exit code is 1.\n",
};
