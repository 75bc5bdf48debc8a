/* methods.h: what the benchmark compares. */
#ifndef BENCH_METHODS_H
#define BENCH_METHODS_H

#include "baseline.h"

struct method {
	const char *name;
	const struct baseline *baseline; /* NULL: a yardstick */
	bool efforts;                    /* climbs the efforts at BUDGET_USUAL, not the budgets */
};

/* In the order of the benchmark's table; what comes after METHOD_FITS is no method, but what they are held against. */
enum { METHOD_FITS = 16, METHOD_CAT = METHOD_FITS, METHOD_RAW_TABLE, METHOD_COUNT };
extern const struct method METHODS[METHOD_COUNT];

/* Marks the methods of a list with commas. False, and *unknown[capacity] filled, where a name is not one. */
bool methods_choose(const char *list, bool on[METHOD_COUNT], char *unknown, size_t capacity);

#endif
