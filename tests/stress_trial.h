/*
 * stress_trial.h: what is measured of a stress material, and how large each figure may be.
 */
#ifndef TESTS_STRESS_TRIAL_H
#define TESTS_STRESS_TRIAL_H

#include "model/model.h"

/*
 * The columns. All are "at most". Decibels are 20 log10 of log RMSE against the first original over the first
 * record's, where either counts as at least 1e-3.
 */
enum property {
	WRONG,      /* outcomes: packed although nothing is valid, refused although something is, values not finite or negative */
	ASYMMETRIC, /* evaluations that change when the directions change places */
	RECORDED,   /* recorded figures of every layer against the slow reference, relative; figures below 1e-6 absolute */
	FIGURES,    /* the same, relative, beyond what the rounding of the terms explains; see figure_deviation */
	SCALE,      /* pack(s B) against s pack(B), relative to the value; see value_deviation */
	PERMUTE,    /* channels exchanged, all three or two of them, in the same way */
	MIRROR,     /* log RMS between pack(mirror B) and mirror(pack(B)), over the larger of their recorded errors */
	FILES_ONE,  /* dB lost by packing an extracted file, where it carries its record */
	FILES_TEN,  /* dB lost by doing so `generations` times */
	PLAIN_ONE,  /* the same without the record: values alone, nothing of what lies below the horizon */
	PLAIN_TEN,
	WHOLE_ONE, /* the same for the whole decoded table, which no file holds */
	WHOLE_TEN,
	MARGINALS,  /* means and scale against exact sums, relative */
	REGRESSION, /* robust_fit against the same steps in long double, where these converge: relative; see deviation_counted */
	GSL,        /* robust_fit against GSL, where that converges, likewise */
	PROPERTY_COUNT
};
extern const char *const PROPERTY_NAMES[PROPERTY_COUNT];

/*
 * format-spec/STRESS.md says why limits are no lower than they are; where a kind of material alone needs another one, it
 * stands in EXCEPTIONS.
 */
struct subject {
	const char *name;
	enum profile profile;
	uint32_t budgets[3]; /* 0: none */
	double limit[PROPERTY_COUNT];
	double binding[4]; /* limits of the columns of generations without the record at the smaller budgets, which bind */
};
enum { SUBJECT_COUNT = 2 };
extern const struct subject SUBJECTS[SUBJECT_COUNT];

double limit_of(const struct subject *subject, uint32_t budget, const char *kind, enum property property);

struct figures {
	double worst[PROPERTY_COUNT];
	unsigned cases, packed, refused, carried; /* carried: of the packed ones, records with room in their extracted file */
};

/* One case at work. */
struct trial {
	const struct subject *subject;
	struct fit_options options;
	const struct lattice *lattice;
	const char *kind, *name;
	struct figures *figures;
	unsigned generations;
	bool verbose; /* cases over the limit on standard error */
};

/* A figure of the case: the worst one stays. NaN is worse than any. */
void note(const struct trial *trial, enum property property, double figure);

#endif
