#include "run.h"

#include <math.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "error.h"
#include "model/fit.h"
#include "merl/merl_file.h"
#include "timing.h"

/* Work that takes less than this is repeated and its median taken. */
static const double SHORT_SECONDS = 0.3;

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
	row.figures.fidelity = (struct fidelity){NAN, NAN, NAN, NAN};
	return row;
}

/* One method at the material's budget and effort. */
static bp_status run_method(struct run *run, const struct bench_material *material, const struct lattice *truth,
                            const struct baseline *method, struct row *row, struct expansion *table, bp_error *error)
{
	double seconds[REPEATS];
	struct fitted fitted = {.state = NULL};
	bp_status status = BP_OK;
	int count = 0;

	do {
		double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
		method->free_state(fitted.state);
		fitted.state = NULL;
		if ((status = method->fit(method, material, &fitted, error)))
			return status;
		seconds[count++] = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
	} while (!run->quick && count < REPEATS && seconds[0] < SHORT_SECONDS);
	row->fit_seconds = median_of(seconds, count);
	row->bytes = (double)fitted.bytes;
	row->parameters = (double)fitted.parameters;
	count = 0;
	do {
		double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
		if ((status = method->expand(fitted.state, table, error)))
			goto out;
		seconds[count++] = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
	} while (count < REPEATS && seconds[0] < SHORT_SECONDS);
	row->decode_seconds = median_of(seconds, count);
	row->evaluated = method->evaluate && !method->prepare ? EVALUATED_MODEL : EVALUATED_TABLE;
	if (method->prepare && (status = method->prepare(fitted.state, table, error)))
		goto out;
	status = method->evaluate ? time_evaluation(method->evaluate, fitted.state, run->pairs, &row->evaluate_ns, error)
	                          : time_evaluation(evaluate_expansion, table, run->pairs, &row->evaluate_ns, error);
	if (!status)
		status = comparison_measure(&run->plans, truth, table, &row->figures, NULL, error);
out:
	method->free_state(fitted.state);
	return status;
}

/* A row of a method for every step of its ladder. */
static void climb(struct run *run, const struct bench_material *material, const struct lattice *truth, int at, int m,
                  struct expansion *table)
{
	const struct method *method = &METHODS[m];
	const int steps = method->efforts ? run->effort_count : method->baseline->budgeted ? run->budget_count : 1;

	for (int n = 0; n < steps; n++) {
		struct row row = empty_row(at, m);
		bp_error error;
		if (method->efforts)
			row.effort = run->efforts[n];
		row.budget = method->efforts ? BUDGET_USUAL : method->baseline->budgeted ? run->budgets[n] : 0;
		struct bench_material asked = *material;
		asked.budget_bytes = (size_t)row.budget;
		asked.effort = method->efforts ? (int)row.effort : EFFORT_USUAL;
		bp_status status = run_method(run, &asked, truth, method->baseline, &row, table, &error);
		if (!status)
			fwrite(&row, sizeof row, 1, run->rows);
		else if (status == BP_ERROR_LIMIT || status == BP_ERROR_UNSUPPORTED ||
		         status == BP_ERROR_ARGUMENT) /* not this budget, or not this build */
			fprintf(stderr, "brdfpack-bench: %s: %s: no row: %s\n", material->name, method->name, error.message);
		else
			complain(run, material->name, method->name, &error);
	}
}

static void run_yardsticks(struct run *run, int at, const char *name, const struct lattice *lattice)
{
	struct row row = empty_row(at, METHOD_CAT);
	double seconds[REPEATS];
	size_t bytes = 0;
	bp_error error;

	if (run->method_on[METHOD_CAT]) {
		for (int n = 0; n < REPEATS; n++)
			if (time_read(run->inputs.items[at].path, &seconds[n], NULL, &bytes, &error)) {
				complain(run, name, "cat", &error);
				return;
			}
		row.bytes = (double)bytes;
		row.decode_seconds = median_of(seconds, REPEATS);
		fwrite(&row, sizeof row, 1, run->rows);
	}
	if (run->method_on[METHOD_RAW_TABLE]) {
		row = empty_row(at, METHOD_RAW_TABLE);
		row.bytes = 3.0 * sizeof(double) * (double)lattice_cells(lattice->dims);
		row.evaluated = EVALUATED_TABLE;
		if (time_evaluation(evaluate_lattice, lattice, run->pairs, &row.evaluate_ns, &error))
			complain(run, name, "raw-table", &error);
		else
			fwrite(&row, sizeof row, 1, run->rows);
	}
}

static bp_status read_truth(const struct run *run, const char *name, struct lattice_dims dims, struct lattice *truth,
                            bp_error *error)
{
	char path[4096];

	snprintf(path, sizeof path, "%s/%s.binary", run->truth, name);
	bp_status status = lattice_read_path(path, &(struct merl_reading){.any_dims = true}, truth, error);
	if (!status && !lattice_dims_equal(truth->dims, dims))
		status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s has other extents than the input", path);
	return status;
}

static void run_material(struct run *run, int at)
{
	const char *path = run->inputs.items[at].path, *name = run->inputs.items[at].name;
	struct lattice lattice = {0}, truth = {0};
	struct expansion table = {0};
	uint8_t *raw = NULL;
	size_t raw_bytes = 0;
	double start = clock_seconds(CLOCK_MONOTONIC), seconds;
	bp_error error;

	if (time_read(path, &seconds, &raw, &raw_bytes, &error) ||
	    lattice_read_path(path, &(struct merl_reading){.any_dims = true}, &lattice, &error)) {
		complain(run, name, "reading", &error);
		goto out;
	}
	if (run->truth && read_truth(run, name, lattice.dims, &truth, &error)) {
		complain(run, name, "reading the truth", &error);
		goto out;
	}
	if (expansion_alloc(lattice.dims, &table, &error)) {
		complain(run, name, "decoding", &error);
		goto out;
	}
	run_yardsticks(run, at, name, &lattice);
	const struct bench_material material = {.name = name, .lattice = &lattice, .raw = raw, .raw_bytes = raw_bytes};
	for (int m = 0; m < METHOD_FITS; m++)
		if (run->method_on[m])
			climb(run, &material, run->truth ? &truth : &lattice, at, m, &table);
	fprintf(stderr, "brdfpack-bench: %s: %.1f s\n", name, clock_seconds(CLOCK_MONOTONIC) - start);
out:
	expansion_free(&table);
	lattice_free(&lattice);
	lattice_free(&truth);
	free(raw);
}

int run_all(struct run *run, int workers, struct row **out)
{
	FILE *files[RUN_WORKERS_MAX];
	pid_t children[RUN_WORKERS_MAX];
	int count = 0, capacity = (int)run->inputs.item_count * METHOD_COUNT * LADDER_MAX;
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
		for (int at = w; at < (int)run->inputs.item_count; at += workers)
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
