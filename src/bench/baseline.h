/*
 * baseline.h: one interface for everything the benchmark compares.
 *
 *     material -> fit -> state (what would be stored) -> expand -> table
 *                                                     -> evaluate one pair of directions
 *
 * A state holds what is stored, in the precision that is stored (float32 parameters, or a
 * codec's bytes), so the bytes that are reported are the bytes that the figures come from.
 */
#ifndef BENCH_BASELINE_H
#define BENCH_BASELINE_H

#include "merl/lattice.h"

/* One measured material as the benchmark holds it, and what a fit of it may spend. */
struct bench_material {
	const char *name;
	const struct lattice *lattice;
	const uint8_t *raw; /* the file's bytes, for the lossless codecs */
	size_t raw_bytes;
	size_t budget_bytes; /* 0 for those that are not budgeted */
	int effort;          /* 1..9, for those that know efforts */
};

/* One evaluation: unit vectors in the local frame (normal = +z), both above the horizon; rgb in 1/sr. */
typedef void evaluate_fn(const void *state, const double wi[3], const double wo[3], double rgb[3]);

/* What a fit made. */
struct fitted {
	void *state;       /* for expand, evaluate, ...; released with free_state */
	size_t bytes;      /* what would be stored */
	size_t parameters; /* numbers stored; 0 where that is a codec's bytes */
};

struct baseline {
	const char *reference; /* author and year, or library */
	bool budgeted;         /* true: fit aims at the budget; false: its size is its own */
	const void *variant;   /* fit's own: which of several methods this is */

	bp_status (*fit)(const struct baseline *self, const struct bench_material *material, struct fitted *out, bp_error *error);

	/* Fills the whole table; the caller has allocated it with the material's dims. Every value is finite and >= 0. */
	bp_status (*expand)(const void *state, struct expansion *out, bp_error *error);

	/*
	 * What a renderer does once after decoding, before it evaluates: may keep things in the state. The
	 * table is not needed afterwards. NULL: nothing.
	 */
	bp_status (*prepare)(void *state, const struct expansion *table, bp_error *error);

	/* NULL: nothing short of decoding the whole can be evaluated; the benchmark then times a nearest look-up in the table. */
	evaluate_fn *evaluate;
	void (*free_state)(void *state); /* NULL is allowed */
};

/* This project's own profiles. */
extern const struct baseline BASELINE_PAPER, BASELINE_SPECTRAL;
/* The analytic models: no budget, tens of bytes. */
extern const struct baseline BASELINE_WARD, BASELINE_COOK_TORRANCE, BASELINE_EDWARDS;
/* The same by relative instead of cosine-weighted error. */
extern const struct baseline BASELINE_WARD_RELATIVE, BASELINE_COOK_TORRANCE_RELATIVE, BASELINE_EDWARDS_RELATIVE;
/* Nothing at all: the floor. */
extern const struct baseline BASELINE_BLACK;
/* Data-driven models of the paper's authors. */
extern const struct baseline BASELINE_ARCHIMEDEAN, BASELINE_TUCKER;
/* General codecs. */
extern const struct baseline BASELINE_ZFP, BASELINE_ZLIB, BASELINE_ZSTD, BASELINE_XZ;

#endif
