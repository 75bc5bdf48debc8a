#include "stress_trial.h"

#include <stdio.h>
#include <string.h>

const char *const PROPERTY_NAMES[PROPERTY_COUNT] = {
	"wrong",     "asymmetric", "recorded",   "figures",    "scale",      "permute",   "mirror",     "file_1_dB",
	"file_n_dB", "plain_1_dB", "plain_n_dB", "whole_1_dB", "whole_n_dB", "marginals", "regression", "gsl",
};

const struct subject SUBJECTS[SUBJECT_COUNT] = {
	{"paper",
     PROFILE_PAPER,
     {60400, 1000, 0},
     {0, 0, 1e-9, 1e-12, 1e-6, 1e-6, 2, 0.1, 1, 70, 80, 70, 80, 1e-5, 1e-12, 1e-12},
     {70, 80, 70, 80}},
	{"spectral",
     PROFILE_SPECTRAL,
     {60400, 1000, 0},
     {0, 0, 1e-9, 1e-12, 1e-6, 0, 2, 0.1, 1, 20, 30, 0.1, 1, 1e-5, 1e-12, 1e-12},
     {120, 120, 120, 120}},
};
static const struct {
	enum profile profile;
	const char *kind;
	enum property property;
	double limit;
} EXCEPTIONS[] = {
	/* What a cell brighter by 12 orders of magnitude leaves around it hangs on the last bits: some thousandths of itself. */
	{PROFILE_PAPER, "bright-cell", SCALE, 1e4},
	{PROFILE_PAPER, "delta-lobe", SCALE, 1},
	/* Ranges beyond single precision: the coefficients' rounding errors are what is lost. */
	{PROFILE_SPECTRAL, "bright-cell", WHOLE_ONE, 10},
	{PROFILE_SPECTRAL, "bright-cell", WHOLE_TEN, 30},
	{PROFILE_SPECTRAL, "checkerboard", WHOLE_ONE, 10},
	{PROFILE_SPECTRAL, "checkerboard", WHOLE_TEN, 10},
	{PROFILE_SPECTRAL, "odd-channel", WHOLE_ONE, 10},
	{PROFILE_SPECTRAL, "odd-channel", WHOLE_TEN, 30},
	/* On MERL's lattice the budget binds. */
	{PROFILE_SPECTRAL, "speckled-mirror", WHOLE_ONE, 2},
	{PROFILE_SPECTRAL, "speckled-mirror", WHOLE_TEN, 6},
	/* Edges and gaps of validity or brightness: a decoded table is fitted like a measurement, not recognised. */
	{PROFILE_SPECTRAL, "random-validity", WHOLE_ONE, 2},
	{PROFILE_SPECTRAL, "random-validity", WHOLE_TEN, 2},
	{PROFILE_SPECTRAL, "step", WHOLE_ONE, 4},
	{PROFILE_SPECTRAL, "step", WHOLE_TEN, 6},
	{PROFILE_SPECTRAL, "missing-slices", WHOLE_ONE, 3},
	{PROFILE_SPECTRAL, "missing-slices", WHOLE_TEN, 3},
	/* A table of noise is taken for noise again, and drawn towards 0 a little more. */
	{PROFILE_SPECTRAL, "noise", WHOLE_ONE, 0.5},
	{PROFILE_SPECTRAL, "nonfinite", WHOLE_ONE, 1},
	{PROFILE_SPECTRAL, "denormal", WHOLE_ONE, 1},
};

double limit_of(const struct subject *subject, uint32_t budget, const char *kind, enum property property)
{
	if (budget != subject->budgets[0] && property >= PLAIN_ONE && property <= WHOLE_TEN)
		return subject->binding[property - PLAIN_ONE];
	for (size_t i = 0; i < sizeof EXCEPTIONS / sizeof *EXCEPTIONS; i++)
		if (EXCEPTIONS[i].profile == subject->profile && EXCEPTIONS[i].property == property && !strcmp(EXCEPTIONS[i].kind, kind))
			return EXCEPTIONS[i].limit;
	return subject->limit[property];
}

void note(const struct trial *trial, enum property property, double figure)
{
	double *worst = &trial->figures->worst[property];
	if (trial->verbose && !(figure <= limit_of(trial->subject, trial->options.budget_bytes, trial->kind, property)))
		fprintf(stderr, "%s %u %s: %s %g\n", trial->subject->name, trial->options.budget_bytes, trial->name,
		        PROPERTY_NAMES[property], figure);
	if (!(figure <= *worst))
		*worst = figure;
}
