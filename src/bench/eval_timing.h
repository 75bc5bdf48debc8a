/*
 * eval_timing.h: what a renderer waits for, in seconds, beside what it would wait for with the raw table.
 *
 * Yardsticks stand in the same round as what is compared with them. Every pass over the random directions is timed
 * after one that is not, so that each table is as warm as its size lets it be.
 */
#ifndef BENCH_EVAL_TIMING_H
#define BENCH_EVAL_TIMING_H

#include <stdbool.h>

#include "brdfpack.h"
#include "inputs.h"

/* Each direction is paired with eight others: pairs are many, and what they are made from stays in the cache, as a renderer's. */
enum { ROUNDS = 7, DIRECTIONS = 1 << 14, PARTNERS = 8, EVALUATIONS = PARTNERS * DIRECTIONS, BATCH = 1024, MOST = MATERIALS_MAX };

enum figure {
	READ_CACHED,
	READ_COLD,
	LOAD_EXPANDED,
	LOAD_COMPACT,
	LOAD_PREVIEW,
	RAW_LIBM,
	RAW_OURS,
	ONE_EXPANDED,
	ONE_COMPACT,
	BATCH_EXPANDED,
	BATCH_COMPACT,
	DRAW,
	DENSITY,
	FIGURES
};

/* The measurements of one figure, over all rounds and materials, in seconds. */
struct series {
	double value[ROUNDS * MOST];
	int count;
};

/* Random directions and numbers; the components of the directions also in arrays of their own, and room for a batch's values. */
struct directions {
	float wi[DIRECTIONS][3], wo[DIRECTIONS][3], u[DIRECTIONS][3];
	float in[6][DIRECTIONS], out[3][BATCH];
};

/* Uniform over the hemisphere, which touches more of the table than what a renderer does. */
void directions_make(struct directions *directions);

/* Loads a material; max_log_rmse and sampling as in bp_load_options. NULL, with a complaint, where it cannot be. */
bp_material *eval_load(const bp_archive *archive, uint64_t index, bp_form form, int sampling, double max_log_rmse,
                       double *seconds);

/*
 * Adds ROUNDS measurements of material `index` to every figure; its MERL file is at `path`. memory: bytes of the expanded and the
 * compact form with sampling. False, with a complaint, where something cannot be read or values do not hold.
 */
bool eval_time(const bp_archive *archive, uint64_t index, const char *path, struct directions *directions,
               struct series all[FIGURES], size_t memory[2]);

/* A Markdown table of the medians, their ratios to the yardsticks and what the project asks for. Reorders the series. */
void eval_table_print(struct series all[FIGURES], const size_t memory[2]);

#endif
