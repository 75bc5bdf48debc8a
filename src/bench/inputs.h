/*
 * inputs.h: the MERL files of a benchmark run. For the benchmark program only: trouble is printed, and answered with false.
 */
#ifndef BENCH_INPUTS_H
#define BENCH_INPUTS_H

#include <stdbool.h>
#include <stddef.h>

#include "row.h"

enum { MATERIALS_MAX = ROW_MEDIAN_MAX };

struct inputs {
	char *paths[MATERIALS_MAX];
	int count;
};

/* A MERL file, or every *.binary of a folder. */
bool inputs_add(struct inputs *inputs, const char *path);
/* In the order of their paths. */
void inputs_sort(struct inputs *inputs);
/* Keeps the materials whose names stand in a file, one per line, as its first tab-separated field. */
bool inputs_keep_listed(struct inputs *inputs, const char *list);
/* Keeps `count` of them, spread over the list. */
void inputs_thin(struct inputs *inputs, int count);
/* Name of a material: the file's stem. */
void inputs_name(const char *path, char *out, size_t capacity);
void inputs_free(struct inputs *inputs);

#endif
