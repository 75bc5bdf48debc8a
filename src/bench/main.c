/*
 * brdfpack-bench: run time against error, for every method and a ladder of budgets.
 *
 * For each material: read and time the file, render the reference, then per method and budget fit, decode, evaluate,
 * measure. Rows come out as tab-separated text under a head of `#` lines (machine, compiler, commit, data, command),
 * one block per method, then the medians over the materials (material `(median)`), then the yardsticks: reading the
 * files as cat does, and nearest look-ups in the raw table.
 *
 * With -j N, N processes share the materials; the rows come back through temporary files and are
 * put in order, so only the times depend on N.
 */
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../error.h"
#include "../merl/merl_file.h"
#include "head.h"
#include "inputs.h"
#include "row.h"
#include "timing.h"

enum { BUDGETS_MAX = 16, METHODS_MAX = 32, WORKERS_MAX = 64, QUICK_MATERIALS = 3, REPEATS = 3 };
/* Work that takes less than this is repeated and its median taken. */
static const double SHORT_SECONDS = 0.3;

static const struct baseline *const METHODS[] = {
	&BASELINE_PAPER, &BASELINE_DEFAULT, &BASELINE_WARD, &BASELINE_COOK_TORRANCE, &BASELINE_EDWARDS, &BASELINE_ARCHIMEDEAN,
	&BASELINE_TUCKER, &BASELINE_ZFP, &BASELINE_ZLIB, &BASELINE_ZSTD, &BASELINE_XZ,
};
/* Rows that no method makes. */
enum { YARDSTICK_READ = sizeof METHODS / sizeof *METHODS, YARDSTICK_RAW_TABLE, METHOD_ROWS };
static const char *const YARDSTICK_NAMES[] = {"cat", "raw-table"};

static const double BUDGETS[] = {4000, 8000, 16000, 30000, 60400, 120000};

struct run {
	struct inputs inputs;
	const char *truth; /* folder of the tables that the figures are taken against; NULL: the inputs themselves */
	bool quick; /* every fit once */
	bool method_on[METHOD_ROWS];
	double budgets[BUDGETS_MAX];
	int budget_count;
	struct figure_plans plans;
	struct lattice_dims dims; /* of the plans */
	struct pairs *pairs;
	FILE *rows; /* binary struct row */
	bool failed;
};

static const char *method_name(int method)
{
	return method < YARDSTICK_READ ? METHODS[method]->name : YARDSTICK_NAMES[method - YARDSTICK_READ];
}

static void complain(struct run *run, const char *material, const char *what, const bp_error *error)
{
	fprintf(stderr, "brdfpack-bench: %s: %s: %s\n", material, what, error->message);
	run->failed = true;
}

static struct row empty_row(int material, int method)
{
	struct row row = {.material = material, .method = method, .fit_seconds = NAN, .decode_seconds = NAN, .evaluate_ns = NAN};

	for (int l = 0; l < LIGHTING_COUNT; l++)
		row.figures.psnr[l] = (struct psnr){NAN, NAN};
	row.figures.fidelity = (struct fidelity){NAN, NAN, NAN};
	return row;
}

/* One method at one budget (0: none). */
static bp_status run_method(struct run *run, const struct bench_material *material, const struct figure_reference *reference,
                            const struct baseline *method, struct row *row, struct expansion *table, bp_error *error)
{
	double seconds[REPEATS];
	void *state = NULL;
	bp_status status = BP_OK;
	int count = 0;

	do {
		double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
		if (state)
			method->free_state(state);
		state = NULL;
		if ((status = method->fit(material, (size_t)row->budget, &state, error)))
			return status;
		seconds[count++] = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
	} while (!run->quick && count < REPEATS && seconds[0] < SHORT_SECONDS);
	row->fit_seconds = median_of(seconds, count);
	row->bytes = (double)method->bytes(state);
	row->parameters = (double)method->parameters(state);
	count = 0;
	do {
		double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
		if ((status = method->expand(state, table, error)))
			goto out;
		seconds[count++] = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
	} while (count < REPEATS && seconds[0] < SHORT_SECONDS);
	row->decode_seconds = median_of(seconds, count);
	row->evaluated = method->evaluate && !method->prepare ? EVALUATED_MODEL : EVALUATED_TABLE;
	if (method->prepare && (status = method->prepare(state, table, error)))
		goto out;
	status = method->evaluate ? time_model(method, state, run->pairs, REPEATS, &row->evaluate_ns, error) :
	                            time_table(table, run->pairs, REPEATS, &row->evaluate_ns, error);
	if (!status)
		status = figures_measure(reference, table, &row->figures, error);
out:
	method->free_state(state);
	return status;
}

static void run_yardsticks(struct run *run, int at, const char *name, const struct lattice *lattice)
{
	struct row row = empty_row(at, YARDSTICK_READ);
	double seconds[REPEATS];
	size_t bytes = 0;
	bp_error error;

	if (run->method_on[YARDSTICK_READ]) {
		for (int n = 0; n < REPEATS; n++)
			if (time_read(run->inputs.paths[at], &seconds[n], NULL, &bytes, &error)) {
				complain(run, name, "cat", &error);
				return;
			}
		row.bytes = (double)bytes;
		row.decode_seconds = median_of(seconds, REPEATS);
		fwrite(&row, sizeof row, 1, run->rows);
	}
	if (run->method_on[YARDSTICK_RAW_TABLE]) {
		row = empty_row(at, YARDSTICK_RAW_TABLE);
		row.bytes = 3.0 * sizeof(double) * (double)lattice_cells(lattice->dims);
		row.evaluated = EVALUATED_TABLE;
		if (time_raw_table(lattice, run->pairs, REPEATS, &row.evaluate_ns, &error))
			complain(run, name, "raw-table", &error);
		else
			fwrite(&row, sizeof row, 1, run->rows);
	}
}

static bool same_dims(struct lattice_dims a, struct lattice_dims b)
{
	return a.theta_h == b.theta_h && a.theta_d == b.theta_d && a.phi_d == b.phi_d;
}

static void run_material(struct run *run, int at)
{
	char name[256];
	struct lattice lattice = {0}, truth = {0};
	struct expansion table = {0};
	struct figure_reference reference = {0};
	uint8_t *raw = NULL;
	size_t raw_bytes = 0;
	double start = clock_seconds(CLOCK_MONOTONIC), seconds;
	bp_error error;

	inputs_name(run->inputs.paths[at], name, sizeof name);
	if (time_read(run->inputs.paths[at], &seconds, &raw, &raw_bytes, &error) ||
	    lattice_read_path(run->inputs.paths[at], NULL, NULL, true, &lattice, &error)) {
		complain(run, name, "reading", &error);
		goto out;
	}
	if (run->truth) {
		char path[4096];
		snprintf(path, sizeof path, "%s/%s.binary", run->truth, name);
		if (lattice_read_path(path, NULL, NULL, true, &truth, &error)) {
			complain(run, name, "reading the truth", &error);
			goto out;
		}
		if (!same_dims(truth.dims, lattice.dims)) {
			error_set(&error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s has other extents than the input", path);
			complain(run, name, "reading the truth", &error);
			goto out;
		}
	}
	if (!same_dims(run->dims, lattice.dims)) {
		figure_plans_free(&run->plans);
		run->plans = (struct figure_plans){{NULL}};
		run->dims = lattice.dims;
		if (figure_plans_make(run->dims, &run->plans, &error)) {
			complain(run, name, "planning the images", &error);
			run->dims = (struct lattice_dims){0};
			goto out;
		}
	}
	if (figure_reference_make(&run->plans, run->truth ? &truth : &lattice, &reference, &error) || expansion_alloc(lattice.dims, &table, &error)) {
		complain(run, name, "rendering the reference", &error);
		goto out;
	}
	run_yardsticks(run, at, name, &lattice);
	const struct bench_material material = {name, &lattice, raw, raw_bytes};
	for (int m = 0; m < YARDSTICK_READ; m++)
		for (int b = 0; run->method_on[m] && b < (METHODS[m]->budgeted ? run->budget_count : 1); b++) {
			struct row row = empty_row(at, m);
			row.budget = METHODS[m]->budgeted ? run->budgets[b] : 0;
			bp_status status = run_method(run, &material, &reference, METHODS[m], &row, &table, &error);
			if (!status)
				fwrite(&row, sizeof row, 1, run->rows);
			else if (status == BP_ERROR_LIMIT || status == BP_ERROR_UNSUPPORTED || status == BP_ERROR_ARGUMENT) /* not this budget, or not this build */
				fprintf(stderr, "brdfpack-bench: %s: %s: no row: %s\n", name, METHODS[m]->name, error.message);
			else
				complain(run, name, METHODS[m]->name, &error);
		}
	fprintf(stderr, "brdfpack-bench: %s: %.1f s\n", name, clock_seconds(CLOCK_MONOTONIC) - start);
out:
	figure_reference_free(&reference);
	expansion_free(&table);
	lattice_free(&lattice);
	lattice_free(&truth);
	free(raw);
}

/* Runs all materials in `workers` processes; the rows, unordered, in *out. */
static int run_all(struct run *run, int workers, struct row **out)
{
	FILE *files[WORKERS_MAX];
	pid_t children[WORKERS_MAX];
	int count = 0, capacity = run->inputs.count * METHOD_ROWS * (BUDGETS_MAX + 1);
	struct row *rows = malloc((size_t)capacity * sizeof *rows);

	for (int w = 0; w < workers; w++)
		if (!rows || !(files[w] = tmpfile())) {
			perror("brdfpack-bench: temporary file");
			exit(1);
		}
	for (int w = 0; w < workers; w++) {
		children[w] = workers > 1 ? fork() : 0;
		if (children[w] < 0) {
			perror("brdfpack-bench: fork");
			exit(1);
		}
		if (children[w])
			continue;
		run->rows = files[w];
		for (int at = w; at < run->inputs.count; at += workers)
			run_material(run, at);
		fflush(run->rows);
		if (workers > 1)
			_exit(run->failed);
	}
	for (int w = 0; w < workers; w++) {
		int status = 0;
		if (workers > 1 && (waitpid(children[w], &status, 0) < 0 || status))
			run->failed = true;
		rewind(files[w]);
		while (count < capacity && fread(&rows[count], sizeof *rows, 1, files[w]) == 1)
			count++;
		fclose(files[w]);
	}
	qsort(rows, (size_t)count, sizeof *rows, row_compare);
	*out = rows;
	return count;
}

static void print_head(FILE *out, const struct run *run, const char *label, int workers)
{
	fprintf(out, "# data: %s; %d materials\n", label, run->inputs.count);
	if (run->truth)
		fprintf(out, "# figures against: the tables of the same names in %s\n", run->truth);
	fprintf(out, "# processes: %d; fit, decode: processor seconds; evaluate: median of %d passes over %d random pairs; cat: wall-clock seconds\n",
	        workers, REPEATS, PAIRS);
	fprintf(out, "# evaluated: model = straight from what is stored; table = after decoding the whole, nearest look-up (paper, default: interpolated, as a renderer reads them)\n");
	for (int m = 0; m < YARDSTICK_READ; m++)
		if (run->method_on[m])
			fprintf(out, "# %s: %s\n", METHODS[m]->name, METHODS[m]->reference);
}

static void print_rows(FILE *out, const struct run *run, const struct row *rows, int count)
{
	char name[256];

	row_print_header(out);
	for (int n = 0; n < count; n++) {
		inputs_name(run->inputs.paths[rows[n].material], name, sizeof name);
		row_print(out, name, method_name(rows[n].method), &rows[n]);
	}
	for (int n = 0, next; n < count; n = next) {
		for (next = n + 1; next < count && rows[next].method == rows[n].method && !(rows[next].budget > rows[n].budget);)
			next++;
		struct row median = row_median(rows + n, next - n);
		row_print(out, "(median)", method_name(median.method), &median);
	}
}

static void choose_methods(struct run *run, const char *list)
{
	char copy[512], *save = NULL;

	snprintf(copy, sizeof copy, "%s", list);
	memset(run->method_on, 0, sizeof run->method_on);
	for (char *word = strtok_r(copy, ",", &save); word; word = strtok_r(NULL, ",", &save)) {
		int m = 0;
		while (m < METHOD_ROWS && strcmp(method_name(m), word))
			m++;
		if (m == METHOD_ROWS) {
			fprintf(stderr, "brdfpack-bench: no method `%s`; there are", word);
			for (m = 0; m < METHOD_ROWS; m++)
				fprintf(stderr, " %s", method_name(m));
			fprintf(stderr, "\n");
			exit(2);
		}
		run->method_on[m] = true;
	}
}

static void choose_budgets(struct run *run, const char *list)
{
	char *end = NULL;

	run->budget_count = 0;
	for (const char *at = list; *at; at = *end == ',' ? end + 1 : end) {
		double budget = strtod(at, &end);
		if (end == at || (*end && *end != ',') || !(budget >= 1 && budget <= 1e9) || run->budget_count == BUDGETS_MAX) {
			fprintf(stderr, "brdfpack-bench: -b wants up to %d numbers of bytes with commas between them, not `%s`\n", BUDGETS_MAX, list);
			exit(2);
		}
		run->budgets[run->budget_count++] = budget;
	}
}

static void usage(FILE *out)
{
	fprintf(out,
	        "Usage: brdfpack-bench [options] FOLDER-OR-MERL-FILE...\n"
	        "Run time against error of every method; a table of tab-separated values.\n"
	        "  -o FILE   where the table goes (standard output)\n"
	        "  -l TEXT   what the data are, for the table's head\n"
	        "  -n FILE   only the materials named there, one per line\n"
	        "  -m LIST   only these methods, with commas: paper,default,ward,...\n"
	        "  -b LIST   budgets in bytes, with commas (4000,8000,16000,30000,60400,120000)\n"
	        "  -t FOLDER figures against the tables of the same names there, not against the inputs\n"
	        "  -q        quick: three materials, spread over the list; every fit once\n"
	        "  -j N      processes (1: times are least disturbed)\n");
}

int main(int argc, char **argv)
{
	static struct run run;
	const char *output = NULL, *label = NULL, *names = NULL;
	char temporary[4096];
	int workers = 1, option, count;
	struct row *rows;
	FILE *out = stdout;

	for (int m = 0; m < METHOD_ROWS; m++)
		run.method_on[m] = true;
	memcpy(run.budgets, BUDGETS, sizeof BUDGETS);
	run.budget_count = sizeof BUDGETS / sizeof *BUDGETS;
	while ((option = getopt(argc, argv, "o:l:n:m:b:t:qj:h")) != -1)
		switch (option) {
		case 'o': output = optarg; break;
		case 'l': label = optarg; break;
		case 'n': names = optarg; break;
		case 'm': choose_methods(&run, optarg); break;
		case 'b': choose_budgets(&run, optarg); break;
		case 't': run.truth = optarg; break;
		case 'q': run.quick = true; break;
		case 'j': workers = atoi(optarg); break;
		case 'h': usage(stdout); return 0;
		default: usage(stderr); return 2;
		}
	for (int n = optind; n < argc; n++)
		if (!inputs_add(&run.inputs, argv[n]))
			return 2;
	inputs_sort(&run.inputs);
	if (names && !inputs_keep_listed(&run.inputs, names))
		return 2;
	if (run.quick)
		inputs_thin(&run.inputs, QUICK_MATERIALS);
	if (!run.inputs.count || workers < 1 || workers > WORKERS_MAX) {
		fprintf(stderr, run.inputs.count ? "brdfpack-bench: -j wants 1 to 64\n" : "brdfpack-bench: no MERL file (*.binary) found\n");
		usage(stderr);
		return 2;
	}
	if (output) { /* written beside, renamed when whole */
		snprintf(temporary, sizeof temporary, "%s.tmp", output);
		if (!(out = fopen(temporary, "w"))) {
			fprintf(stderr, "brdfpack-bench: %s: %s\n", temporary, strerror(errno));
			return 1;
		}
	}
	if (!(run.pairs = malloc(sizeof *run.pairs))) {
		fprintf(stderr, "brdfpack-bench: out of memory\n");
		return 1;
	}
	pairs_make(run.pairs);
	count = run_all(&run, workers < run.inputs.count ? workers : run.inputs.count, &rows);
	head_print(out, argc, argv);
	print_head(out, &run, label ? label : argv[optind], workers);
	print_rows(out, &run, rows, count);
	if (fflush(out) || ferror(out) || (output && (fclose(out) || rename(temporary, output)))) {
		fprintf(stderr, "brdfpack-bench: %s: %s\n", output ? output : "standard output", strerror(errno));
		if (output)
			unlink(temporary);
		return 1;
	}
	free(rows);
	free(run.pairs);
	figure_plans_free(&run.plans);
	inputs_free(&run.inputs);
	return run.failed;
}
