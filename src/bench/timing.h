/*
 * timing.h: clocks, and the timed parts of a benchmark run.
 *
 * Work is timed in processor seconds of this process (one thread), which a busy machine disturbs least;
 * reading files in wall-clock seconds.
 */
#ifndef BENCH_TIMING_H
#define BENCH_TIMING_H

#include <time.h>

#include "baseline.h"

static inline double clock_seconds(clockid_t clock)
{
	struct timespec now;

	clock_gettime(clock, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The median of `count` values, at most 16 (of an even count, the lower middle one); reorders them. */
double median_of(double *values, int count);

/* The next number of a generator in [0, 1); `u` is its state, not 0. */
double uniform_next(unsigned long long *u);

/*
 * Pairs of directions, cosine-distributed over the hemisphere, above 1 degree over the horizon: the same
 * ones in every run. Enough of them that tables do not stay in the cache.
 */
enum { PAIRS = 1 << 16, REPEATS = 3 };
struct pairs {
	double wi[PAIRS][3], wo[PAIRS][3];
};
void pairs_make(struct pairs *out);

/* Median nanoseconds per evaluation of REPEATS passes over the pairs; every result is checked to be finite and >= 0. */
bp_status time_evaluation(evaluate_fn *evaluate, const void *state, const struct pairs *pairs, double *ns, bp_error *error);
/* Nearest look-up in a decoded table of float (the state: a struct expansion) ... */
evaluate_fn evaluate_expansion;
/* ... and in the raw table of double (a struct lattice): the yardstick of a renderer that reads the measured file. */
evaluate_fn evaluate_lattice;

/* Reads a whole file as cat does, 128 KiB at a time; wall-clock seconds. *bytes, unless NULL, gets its bytes (malloc'ed). */
bp_status time_read(const char *path, double *seconds, uint8_t **bytes, size_t *count, bp_error *error);

#endif
