/*
 * robust.h: robust linear regression y = intercept + slope x (DuMouchel and O'Brien 1989).
 *
 * Ordinary least squares first. Leverages h = 1/n + (x - mean)^2/Sxx of the unweighted design, clipped at
 * 0.9999. Then, at most 100 times (5,000 for a channel of a material):
 *
 *     v = r/sqrt(1 - h)                            r = y - intercept - slope x
 *     s = median|v|/0.6745                         without the smallest |v|; not centred
 *     u = v/(4.685 max(s, 1e-6 sd(y)))             sd(y) counts as 1e6 where it is 0
 *     w = (1 - u^2)^2 where |u| < 1, else 0        and weighted least squares
 *
 * until each coefficient changes by at most sqrt(eps) max(|c|, |previous c|). This is what GSL's
 * gsl_multifit_robust does with gsl_multifit_robust_bisquare. Where x is constant (over all observations, or
 * over those that still have weight) the two coefficients are not determined; the answer is then the one of least
 * norm after the columns 1 and x were scaled by powers of two to similar size, which is GSL's choice too.
 *
 * One deviation, for speed: where the intercept's change is below the rounding errors of the data (8 eps times the
 * size of the terms it is the difference of) and the slope's below 8 eps of itself, they count as converged even if the
 * intercept is nearly 0; GSL goes on to its iteration limit there, with the same result.
 *
 * On measured materials the slope, which a few bright cells decide, often creeps on for hundreds of iterations; the
 * limit of 100 then ends it before it converges, here as in GSL. Converging faster by extrapolation was tried: it ends
 * at other fixed points than the plain iteration, also where that converges, so each step is the plain one. A few materials
 * amplify rounding errors on the way: of 27 regressions on surrogates, three end 1e-5 to 1e-3 apart in the slope when only the
 * order of additions differs.
 *
 * Per iteration the observations are read twice and copied never: the median is found by counting what lies
 * below a bracket around the expected median and collecting the few inside it. Where the line moves little, one
 * pass serves many iterations (robust_anchor.h); whether it is worth that is told from a sample of the observations.
 * Sums are compensated and taken about the weighted mean of the iteration before, so neither a large common
 * offset nor a tiny or huge unit (1e-300 to 1e300) loses digits. Where the weights leave for observations far from that
 * mean, against their spread, the sums are taken once more about the new one; and where residuals are so small that the
 * rounding of the mean itself is seen in them, what it took is subtracted from each. Then the lines are those of the same
 * steps in long double to what half a unit of the observations' last places moves (tests/stress_checks.c).
 */
#ifndef MODEL_ROBUST_ROBUST_H
#define MODEL_ROBUST_ROBUST_H

#include "merl/lattice.h"

enum { ROBUST_ITERATIONS_MAX = 100, ROBUST_CHANNEL_ITERATIONS_MAX = 5000 };

/* A line; of a channel on its model: measured = diffuse + specular * model (1/sr). */
struct colour_fit {
	double diffuse;  /* the intercept; 1/sr */
	double specular; /* the slope; the model is in 1/sr, so this is a ratio */
	uint32_t iterations;
	uint32_t converged; /* 1 or 0 */
	double rejected;    /* share of the observations that had weight 0 in the last iteration */
};

/*
 * n >= 1 finite observations. One observation: intercept y, slope 0. BP_ERROR_ARGUMENT for n = 0,
 * BP_ERROR_MEMORY. Takes 24 n bytes of its own (32 n while it runs). Deterministic.
 */
bp_status robust_fit(const double *x, const double *y, size_t n, struct colour_fit *out, bp_error *error);

/*
 * The regression of a channel's measured values (1/sr) on unit * model over the lattice's valid cells; model[cells]. Terms below
 * 2^-126 of the channel's largest value are 0. It goes on until it converges, which takes 10 to 2,000 iterations on measured
 * materials.
 */
bp_status robust_fit_channel(const struct lattice *lattice, int channel, const float *model, double unit, struct colour_fit *out,
                             bp_error *error);

#endif
