/*
 * brdfpack-bench: run time against error, for every method and a ladder of budgets (methods.h, run.h).
 *
 * Rows come out as tab-separated text under a head of `#` lines (machine, compiler, commit, data, command), one block
 * per method, then the medians over the materials (material `(median)`), then the yardsticks.
 */
#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "head.h"
#include "run.h"

enum { QUICK_MATERIALS = 3 };

static const double BUDGETS[] = {4000, 8000, 16000, 30000, 60400, 120000};
static const double EFFORTS[] = {1, 2, 3, 4, 5, 6, 7, 8, 9}, QUICK_EFFORTS[] = {1, 5, 9};

static void print_head(FILE *out, const struct run *run, const char *label, int workers)
{
	fprintf(out, "# data: %s; %d materials\n", label, (int)run->inputs.item_count);
	if (run->truth)
		fprintf(out, "# figures against: the tables of the same names in %s\n", run->truth);
	fprintf(out,
	        "# processes: %d; fit, decode: processor seconds; "
	        "evaluate: median of %d passes over %d random pairs; cat: wall-clock seconds\n",
	        workers, REPEATS, PAIRS);
	fprintf(out, "# evaluated: model = straight from what is stored; "
	             "table = after decoding the whole, nearest look-up (paper, spectral: interpolated, as a renderer reads them)\n");
	for (int m = 0; m < METHOD_FITS; m++)
		if (run->method_on[m])
			fprintf(out, "# %s: %s%s\n", METHODS[m].name, METHODS[m].baseline->reference,
			        METHODS[m].efforts ? ", by effort" : "");
}

static void print_rows(FILE *out, const struct run *run, const struct row *rows, int count)
{
	row_print_header(out);
	for (int n = 0; n < count; n++)
		row_print(out, run->inputs.items[rows[n].material].name, METHODS[rows[n].method].name, &rows[n]);
	for (int n = 0, next; n < count; n = next) {
		for (next = n + 1; next < count && row_same_setting(&rows[next], &rows[n]);)
			next++;
		struct row median = row_median(rows + n, next - n);
		row_print(out, "(median)", METHODS[median.method].name, &median);
	}
}

static void choose_methods(struct run *run, const char *list)
{
	char unknown[64];

	if (methods_choose(list, run->method_on, unknown, sizeof unknown))
		return;
	fprintf(stderr, "brdfpack-bench: no method `%s`; there are", unknown);
	for (int m = 0; m < METHOD_COUNT; m++)
		fprintf(stderr, " %s", METHODS[m].name);
	fprintf(stderr, "\n");
	exit(2);
}

/* Numbers from least to most with commas between them; returns how many. */
static int choose_numbers(const char *list, char option, double least, double most, double out[LADDER_MAX])
{
	char *end = NULL;
	int count = 0;

	for (const char *at = list; *at; at = *end == ',' ? end + 1 : end) {
		double number = strtod(at, &end);
		if (end == at || (*end && *end != ',') || !(number >= least && number <= most) || count == LADDER_MAX) {
			fprintf(stderr, "brdfpack-bench: -%c wants up to %d numbers from %g to %g with commas between them, not `%s`\n",
			        option, LADDER_MAX, least, most, list);
			exit(2);
		}
		out[count++] = number;
	}
	return count;
}

static void usage(FILE *out)
{
	fprintf(out, "Usage: brdfpack-bench [options] FOLDER-OR-MEASURED-FILE...\n"
	             "Run time against error of every method; a table of tab-separated values.\n"
	             "  -o FILE   where the table goes (standard output)\n"
	             "  -l TEXT   what the data are, for the table's head\n"
	             "  -n FILE   only the materials named there, one per line\n"
	             "  -m LIST   only these methods, with commas: paper,spectral,ward,...\n"
	             "  -b LIST   budgets in bytes, with commas (4000,8000,16000,30000,60400,120000)\n"
	             "  -e LIST   efforts of the spectral profile at 60400 bytes, with commas (1,2,...,9)\n"
	             "  -t FOLDER figures against the tables of the same names there, not against the inputs\n"
	             "  -q        quick: three materials, spread over the list, three efforts; every fit once\n"
	             "  -j N      processes (1: times are least disturbed)\n");
}

/* Everything, to standard output (NULL) or a file, which is written beside and renamed when whole. False after a complaint. */
static bool run_and_print(struct run *run, int workers, const char *output, const char *label, int argc, char **argv)
{
	char temporary[4096];
	struct row *rows;
	FILE *out = stdout;

	snprintf(temporary, sizeof temporary, "%s.tmp", output ? output : "");
	if (output && !(out = fopen(temporary, "w"))) {
		fprintf(stderr, "brdfpack-bench: %s: %s\n", temporary, strerror(errno));
		return false;
	}
	const int count = run_all(run, workers < (int)run->inputs.item_count ? workers : (int)run->inputs.item_count, &rows);
	head_print(out, argc, argv);
	print_head(out, run, label, workers);
	print_rows(out, run, rows, count);
	free(rows);
	const bool flushed = fflush(out) == 0 && !ferror(out);
	if ((output && fclose(out) != 0) || !flushed || (output && rename(temporary, output) != 0)) {
		fprintf(stderr, "brdfpack-bench: %s: %s\n", output ? output : "standard output", strerror(errno));
		if (output)
			unlink(temporary);
		return false;
	}
	return true;
}

int main(int argc, char **argv)
{
	static struct run run = {.plans = {.lightings = (1u << LIGHTING_COUNT) - 1, .size = SPHERE_SIZE}};
	const char *output = NULL, *label = NULL, *names = NULL;
	int workers = 1, option;

	for (int m = 0; m < METHOD_COUNT; m++)
		run.method_on[m] = true;
	memcpy(run.budgets, BUDGETS, sizeof BUDGETS);
	run.budget_count = sizeof BUDGETS / sizeof *BUDGETS;
	while ((option = getopt(argc, argv, "o:l:n:m:b:e:t:qj:h")) != -1)
		switch (option) {
		case 'o': output = optarg; break;
		case 'l': label = optarg; break;
		case 'n': names = optarg; break;
		case 'm': choose_methods(&run, optarg); break;
		case 'b': run.budget_count = choose_numbers(optarg, 'b', 1, 1e9, run.budgets); break;
		case 'e': run.effort_count = choose_numbers(optarg, 'e', 1, 9, run.efforts); break;
		case 't': run.truth = optarg; break;
		case 'q': run.quick = true; break;
		case 'j': workers = atoi(optarg); break;
		case 'h': usage(stdout); return 0;
		default: usage(stderr); return 2;
		}
	if (!run.effort_count) {
		run.effort_count = run.quick ? (int)(sizeof QUICK_EFFORTS / sizeof *EFFORTS) : (int)(sizeof EFFORTS / sizeof *EFFORTS);
		memcpy(run.efforts, run.quick ? QUICK_EFFORTS : EFFORTS, (size_t)run.effort_count * sizeof *EFFORTS);
	}
	if (!inputs_find(argv + optind, argc - optind, names, &run.inputs))
		return 2;
	if (run.quick)
		inputs_thin(&run.inputs, QUICK_MATERIALS);
	if (!run.inputs.item_count || workers < 1 || workers > RUN_WORKERS_MAX) {
		fprintf(stderr,
		        run.inputs.item_count ? "brdfpack-bench: -j wants 1 to 64\n" : "brdfpack-bench: no measured file found\n");
		usage(stderr);
		return 2;
	}
	if (!(run.pairs = malloc(sizeof *run.pairs))) {
		fprintf(stderr, "brdfpack-bench: out of memory\n");
		return 1;
	}
	pairs_make(run.pairs);
	bool written = run_and_print(&run, workers, output, label ? label : argv[optind], argc, argv);
	free(run.pairs);
	comparison_plans_free(&run.plans);
	source_list_free(&run.inputs);
	return run.failed || !written;
}
