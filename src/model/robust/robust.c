#include "robust.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "robust_kernels.h"
#include "robust_walk.h"

static const double LEVERAGE_MAX = 0.9999;

/* ---- preparation ---- */

enum { ANCHOR_WORTH = 1 << 15 };

/* The observations, and what the unweighted design gives once. */
struct design {
	double *x;      /* n values, the largest about 1; owns what follows */
	double *y;      /* likewise */
	double *excess; /* 1/sqrt(1 - h) - 1 */
	double *inside; /* n + 1: values gathered around the median */
	double *picked; /* room for x, y and excess of robust_picks(n) observations */
	size_t n;
	double mean_x;
	struct robust_anchor anchor; /* room for one, or empty where n is small */
};

static void design_free(struct design *design)
{
	free(design->x);
	free(design->anchor.near.x);
}

static bp_status design_alloc(size_t n, struct design *design, bp_error *error)
{
	const size_t bytes = (4 * n + 1 + 3 * robust_picks(n)) * sizeof(double);

	*design = (struct design){.n = n, .x = malloc(bytes)};
	if (!design->x)
		return error_memory(error, bytes);
	design->y = design->x + n;
	design->excess = design->y + n;
	design->inside = design->excess + n;
	design->picked = design->inside + n + 1;
	/* Few observations are read through as quickly as an anchor is placed. */
	return n < ANCHOR_WORTH ? BP_OK : robust_anchor_alloc(n / 6, &design->anchor, error);
}

static double largest_size(const double *v, size_t n)
{
	double largest[4] = {0}; /* apart, so that they are compared side by side */
	size_t i = 0;

	for (; i + 4 <= n; i += 4)
		for (size_t l = 0; l < 4; l++)
			largest[l] = fabs(v[i + l]) > largest[l] ? fabs(v[i + l]) : largest[l];
	for (; i < n; i++)
		largest[0] = fabs(v[i]) > largest[0] ? fabs(v[i]) : largest[0];
	return fmax(fmax(largest[0], largest[1]), fmax(largest[2], largest[3]));
}

/* The exponent e with largest |v| in [2^(e-1), 2^e); 0 when all are 0. */
static int exponent_of(double largest)
{
	int e = 0;
	if (largest > 0)
		frexp(largest, &e);
	return e;
}

/* v * 2^-e where 2^e may lie outside the range of double. */
struct power {
	double a, b;
};
static struct power power_of(int e) { return (struct power){ldexp(1, e / 2), ldexp(1, e - e / 2)}; }

/* Mean and leverages of the scaled x. */
static void design_prepare(struct design *design)
{
	const struct robust_kernels *kernels = robust_kernels_get();
	const double *x = design->x, n = (double)design->n;
	const struct robust_sample sample = {x, x, design->excess, design->n};
	struct robust_line line = {x[0], x[0], 0, 0};
	struct robust_sums sums;

	for (size_t i = 0; i < design->n; i++)
		design->excess[i] = 0;
	kernels->robust_sums(&sample, &line, 0, &sums);
	design->mean_x = x[0] + sums.wx / n; /* exact when x is constant */
	line.centre_x = line.centre_y = design->mean_x;
	kernels->robust_sums(&sample, &line, 0, &sums);

	const double sxx = sums.wxx - sums.wx * (sums.wx / n), inverse = sxx > 0 ? 1 / sxx : 0, mean = design->mean_x,
				 base = 1 - 1 / n, least = 1 - LEVERAGE_MAX;
	for (size_t i = 0; i < design->n; i++) {
		double d = x[i] - mean, rest = base - d * d * inverse;
		design->excess[i] = 1 / sqrt(rest < least ? least : rest) - 1;
	}
}

/* ---- the fit ---- */

/* Copies the picks: where they stand, every one would be a cache miss each time. */
static struct robust_sample picks_copy(struct design *design)
{
	const size_t count = robust_picks(design->n);
	double *x = design->picked, *y = x + count, *excess = y + count;

	for (size_t k = 0; k < count; k++) {
		const size_t i = k * design->n / count;
		x[k] = design->x[i];
		y[k] = design->y[i];
		excess[k] = design->excess[i];
	}
	return (struct robust_sample){x, y, excess, count};
}

/* The regression of y on x of a prepared design: coefficients in the scaled units. n >= 2. At most `limit` iterations. */
static void design_iterate(struct design *design, uint32_t limit, struct colour_fit *out)
{
	struct walk walk = {
		.kernels = robust_kernels_get(),
		.sample = {design->x, design->y, design->excess, design->n},
		.picks = picks_copy(design),
		.inside = design->inside,
		.line = {design->mean_x, design->y[0], 0, 0},
		.anchor = design->anchor.near.capacity ? &design->anchor : NULL,
	};

	walk_start(&walk);
	design->anchor.placed = false;
	out->converged = 0;
	out->iterations = 0;
	while (!out->converged && out->iterations < limit) {
		out->iterations++;
		walk_step(&walk, limit - out->iterations);
		out->converged = line_settled(&walk.before, &walk.line);
	}
	out->rejected = (double)walk.sums.rejected / (double)design->n;
	out->specular = walk.line.slope;
	out->diffuse = line_intercept(&walk.line);
}

/*
 * Where most of a channel is dark, its line sinks towards 0 for as long as there are numbers to sink to; where that ends would
 * hang on the unit of measure. Terms beyond the range of single precision are 0: the largest x and y are about 1 here.
 */
static void fit_still(struct colour_fit *fit)
{
	if (fabs(fit->diffuse) < FLT_MIN)
		fit->diffuse = 0;
	if (fabs(fit->specular) < FLT_MIN)
		fit->specular = 0;
}

/*
 * The regression of design->y on unit * design->x, n of each: both are scaled by powers of two to about 1, and the line back. The
 * unit enters by its exponent and mantissa, so that it may be of any size. `still`: fit_still.
 */
static void design_fit(struct design *design, double unit, uint32_t limit, bool still, struct colour_fit *out)
{
	const size_t n = design->n;
	const int float_exponent = exponent_of(largest_size(design->x, n)), y_exponent = exponent_of(largest_size(design->y, n));
	const struct power p = power_of(-float_exponent), q = power_of(-y_exponent);
	int unit_exponent;
	const double mantissa = frexp(unit, &unit_exponent);

	for (size_t k = 0; k < n; k++) {
		design->x[k] = design->x[k] * p.a * p.b * mantissa;
		design->y[k] = design->y[k] * q.a * q.b;
	}
	if (n == 1) {
		*out = (struct colour_fit){.diffuse = design->y[0], .converged = 1};
	} else {
		design_prepare(design);
		design_iterate(design, limit, out);
	}
	if (still)
		fit_still(out);
	const struct power back = power_of(y_exponent), slope = power_of(y_exponent - float_exponent - unit_exponent);
	out->diffuse = out->diffuse * back.a * back.b;
	out->specular = out->specular * slope.a * slope.b;
}

bp_status robust_fit(const double *x, const double *y, size_t n, struct colour_fit *out, bp_error *error)
{
	struct design design;

	if (!n)
		return error_argument(error, "robust regression: no observation");
	bp_status status = design_alloc(n, &design, error);
	if (!status) {
		memcpy(design.x, x, n * sizeof *x);
		memcpy(design.y, y, n * sizeof *y);
		design_fit(&design, 1, ROBUST_ITERATIONS_MAX, false, out);
	}
	design_free(&design);
	return status;
}

/* The next run of valid cells behind *end: cells *start to *end - 1. False when there is none. */
static bool run_next(const struct lattice *lattice, size_t *start, size_t *end)
{
	const size_t cells = lattice_cells(lattice->dims);
	const uint8_t *valid = lattice->valid, *from = *end < cells ? memchr(valid + *end, 1, cells - *end) : NULL, *to;

	if (!from)
		return false;
	to = memchr(from, 0, (size_t)(valid + cells - from));
	*start = (size_t)(from - valid);
	*end = to ? (size_t)(to - valid) : cells;
	return true;
}

bp_status robust_fit_channel(const struct lattice *lattice, int channel, const float *model, double unit, struct colour_fit *out,
                             bp_error *error)
{
	const size_t n = lattice->valid_count;
	struct design design;
	size_t k = 0;

	if (!n)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "no valid cell");
	bp_status status = design_alloc(n, &design, error);
	if (!status) {
		for (size_t i = 0, end = 0; run_next(lattice, &i, &end); k += end - i) {
			memcpy(design.y + k, lattice->rgb[channel] + i, (end - i) * sizeof *design.y);
			for (size_t m = i; m < end; m++)
				design.x[k + m - i] = (double)model[m];
		}
		design_fit(&design, unit, ROBUST_CHANNEL_ITERATIONS_MAX, true, out);
	}
	design_free(&design);
	return status;
}
