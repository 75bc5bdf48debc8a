/*
 * row.h: one line of the benchmark's table, its text, and the medians over materials.
 */
#ifndef BENCH_ROW_H
#define BENCH_ROW_H

#include <stdio.h>

#include "render/comparison.h"

enum evaluated { EVALUATED_NOTHING, EVALUATED_MODEL, EVALUATED_TABLE };

struct row {
	int material, method; /* positions in the lists of the run */
	double budget;        /* bytes; 0: the method has no budget */
	double effort;        /* 1 to 9; 0: the usual one, or the method has none */
	double bytes, parameters;
	double fit_seconds, decode_seconds, evaluate_ns;
	int evaluated; /* enum evaluated: from what the evaluation was timed */
	struct comparison figures;
};

/* Column names, tab-separated, with newline. */
void row_print_header(FILE *out);
/* One line. A figure that is not finite (or was not measured) prints as `-`. */
void row_print(FILE *out, const char *material, const char *method, const struct row *row);

/* Orders rows by method, budget, effort, material. */
int row_compare(const void *a, const void *b);
/* Whether they differ in the material only. */
bool row_same_setting(const struct row *a, const struct row *b);

/*
 * The column-wise median of `count` > 0 rows of one setting (of an even count, the mean of
 * the two middle ones). count <= ROW_MEDIAN_MAX.
 */
enum { ROW_MEDIAN_MAX = 1024 };
struct row row_median(const struct row *rows, int count);

#endif
