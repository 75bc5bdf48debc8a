/*
 * run.h: one run of the benchmark: every material by every method.
 *
 * For each material: read and time the file, then per method and budget (or effort) fit, decode,
 * evaluate, measure; and the yardsticks: reading the file as cat does, and nearest look-ups in the raw table.
 */
#ifndef BENCH_RUN_H
#define BENCH_RUN_H

#include "inputs.h"
#include "methods.h"
#include "timing.h"

enum { LADDER_MAX = 16, RUN_WORKERS_MAX = 64 };

struct run {
	struct source_list inputs;
	const char *truth; /* folder of the tables that the figures are taken against; NULL: the inputs themselves */
	bool quick;        /* every fit once */
	bool method_on[METHOD_COUNT];
	double budgets[LADDER_MAX], efforts[LADDER_MAX];
	int budget_count, effort_count;
	/* the run's own, zero before it */
	struct comparison_plans plans; /* with lightings and size set */
	struct pairs *pairs;           /* the caller's */
	FILE *rows;                    /* binary struct row */
	bool failed;                   /* something was reported on standard error */
};

/*
 * Runs all materials in `workers` processes (1: in this one), which come back through temporary files; *out has the rows, as many
 * as are returned, ordered by row_compare; the caller frees it. Only the times depend on `workers`. For the benchmark
 * program: trouble is printed.
 */
int run_all(struct run *run, int workers, struct row **out);

#endif
