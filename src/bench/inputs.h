/*
 * inputs.h: the measured files of a benchmark run. For the benchmark programs only: trouble is printed, and answered with false.
 */
#ifndef BENCH_INPUTS_H
#define BENCH_INPUTS_H

#include "merl/source.h"
#include "row.h"

enum { MATERIALS_MAX = ROW_MEDIAN_MAX };

/*
 * What `build` would find in files and folders, in the order of the names. With a list (else NULL) only materials whose names
 * stand in that file, one per line, as its first tab-separated field. What lies in containers is refused: files are timed. The
 * caller frees with source_list_free.
 */
bool inputs_find(char **paths, int count, const char *list, struct source_list *out);

/* Keeps `count` of them, spread over the list. */
void inputs_thin(struct source_list *inputs, size_t count);

#endif
