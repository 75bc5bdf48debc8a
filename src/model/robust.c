#include "robust.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "../error.h"
#include "kernels.h"
#include "select.h"

static const double TUNING = 4.685, MAD_TO_SIGMA = 0.6745, LEVERAGE_MAX = 0.9999;

/* What the unweighted design gives once for all channels of it. */
struct design {
	double *x;     /* n values, scaled by 2^-x_exponent */
	float *excess; /* 1/sqrt(1 - h) - 1 */
	double *inside; /* n + 1: values gathered around the median */
	size_t n;
	int x_exponent;
	double mean_x, sxx;
};

/* ---- order statistics ---- */

/* The mean of the order statistics k and k2 (k2 = k or k + 1) of v. */
static double select_middle(double *v, size_t n, size_t k, size_t k2)
{
	double a = select_kth(v, n, k);
	if (k2 == k)
		return a;
	double b = v[k2];
	for (size_t i = k2 + 1; i < n; i++)
		b = v[i] < b ? v[i] : b;
	return 0.5 * (a + b);
}

/* A guess at where the median lies, from 2048 evenly spread observations: about six standard errors of rank wide. */
static void guess_bracket(const struct robust_sample *sample, const struct robust_line *line, double *scratch, double *low, double *high)
{
	enum { PICKS = 2048, MARGIN = 140 };
	if (sample->n < 4 * PICKS) {
		*low = 0;
		*high = DBL_MAX;
		return;
	}
	for (size_t k = 0; k < PICKS; k++) {
		size_t i = (size_t)((double)k * ((double)sample->n / PICKS));
		double r = (sample->y[i] - line->centre_y) - line->slope * (sample->x[i] - line->centre_x);
		scratch[k] = fabs(r + r * (double)sample->excess[i]);
	}
	*low = select_kth(scratch, PICKS, PICKS / 2 - MARGIN);
	*high = select_kth(scratch, PICKS, PICKS / 2 + MARGIN);
}

/* The median of |v| without the smallest; *last and *spread carry the expectation from one iteration to the next. */
static double residual_median(const struct kernels *kernels, const struct robust_sample *sample, const struct robust_line *line,
                              double *inside, double *last, double *spread)
{
	/* The n - 1 larger values have their middle at ranks 1 + (n-2)/2 and 1 + (n-1)/2 of all. */
	const size_t k = 1 + (sample->n - 2) / 2, k2 = 1 + (sample->n - 1) / 2;
	double low, high, median;
	size_t below, count;

	if (*spread > 0 && *spread < 0.02) {
		low = *last * (1 - *spread);
		high = *last * (1 + *spread);
	} else {
		guess_bracket(sample, line, inside, &low, &high);
	}
	count = kernels->robust_scale(sample, line, low, high, inside, &below);
	if (k < below || k2 >= below + count) { /* missed: the same again over the side where it must be */
		double from = k < below ? 0 : k < below + count ? low : high;
		double to = k2 < below ? low : k2 < below + count ? high : DBL_MAX;
		count = kernels->robust_scale(sample, line, from, to, inside, &below);
	}
	median = select_middle(inside, count, k - below, k2 - below);
	/* The change shrinks by a steady excess: twice the last one is a safe guess. */
	*spread = *last > 0 ? fmax(1e-4, 2 * fabs(median / *last - 1)) : 0;
	*last = median;
	return median;
}

/* ---- least squares ---- */

/* The power of two that brings a column's absolute sum into [1/2, 1]. */
static double balance(double absolute_sum)
{
	if (!(absolute_sum > 0) || !isfinite(absolute_sum))
		return 1;
	int e;
	double m = frexp(absolute_sum, &e); /* m in [1/2, 1) */
	return ldexp(1, m == 0.5 ? e - 1 : e);
}

/*
 * One weighted step from *line, given the sums about it: to the least squares line, or, when the weighted x
 * do not span a line, to the solution of least balanced norm.
 */
static void line_step(const struct robust_sums *s, struct robust_line *line)
{
	const double mean_dx = s->wx / s->w, mean_r = s->wr / s->w;
	const double sxx = s->wxx - s->wx * mean_dx, sxr = s->wxr - s->wr * mean_dx;
	const double x = line->centre_x + mean_dx, y = line->centre_y + line->slope * mean_dx + mean_r;
	const double d0 = balance(s->root), d1 = balance(s->root * fabs(x));
	/* Squared singular values of the balanced columns. */
	const double trace = s->w / (d0 * d0) + (sxx + s->w * x * x) / (d1 * d1);
	const double determinant = (s->w / (d0 * d0)) * (fmax(0, sxx) / (d1 * d1));
	const double largest = 0.5 * (trace + sqrt(fmax(0, trace * trace - 4 * determinant)));

	line->centre_x = x;
	line->centre_y = y;
	if (determinant > DBL_EPSILON * DBL_EPSILON * largest * largest) {
		line->slope += sxr / sxx;
	} else {
		double a0 = 1 / d0, a1 = x / d1;
		line->slope = y * a1 / (a0 * a0 + a1 * a1) / d1;
	}
}

static double line_intercept(const struct robust_line *line)
{
	return line->centre_y - line->slope * line->centre_x;
}

/* |a - b| <= tolerance max(|a|, |b|) */
static bool close_to(double a, double b, double tolerance)
{
	return fabs(a - b) <= tolerance * fmax(fabs(a), fabs(b));
}

/* The regression of y (scaled by a power of two) on a prepared design; coefficients in the scaled units. */
static void fit_prepared(const struct design *design, const double *y, struct robust_fit *out)
{
	const struct kernels *kernels = kernels_get();
	const struct robust_sample sample = {design->x, y, design->excess, design->n};
	struct robust_line line = {design->mean_x, y[0], 0};
	const double n = (double)design->n;
	struct robust_sums sums;

	/* Ordinary least squares: weights 1, first for the mean of y, then about it. */
	kernels->robust_sums(&sample, &line, 0, &sums);
	line.centre_y += sums.wr / n;
	double syy = 0, rest = 0;
	for (size_t start = 0; start < design->n; start += 512) {
		double part = 0;
		for (size_t i = start; i < design->n && i < start + 512; i++)
			part += (y[i] - line.centre_y) * (y[i] - line.centre_y);
		double t = syy + part;
		rest += syy - t + part;
		syy = t;
	}
	double sigma_least = 1e-6 * sqrt((syy + rest) / (n - 1));
	if (!(sigma_least > 0))
		sigma_least = 1;
	kernels->robust_sums(&sample, &line, 0, &sums);
	line_step(&sums, &line);

	double last = 0, spread = 0;
	out->converged = false;
	out->iterations = 0;
	while (!out->converged && out->iterations < ROBUST_ITERATIONS_MAX) {
		const double slope = line.slope, intercept = line_intercept(&line);
		double sigma = residual_median(kernels, &sample, &line, design->inside, &last, &spread) / MAD_TO_SIGMA;

		sigma = fmax(sigma, sigma_least);
		kernels->robust_sums(&sample, &line, 1 / (TUNING * sigma), &sums);
		line_step(&sums, &line);
		out->iterations++;

		const double tolerance = sqrt(DBL_EPSILON);
		const double terms = fabs(line.centre_y) + fabs(line.slope * line.centre_x);
		out->converged = close_to(line.slope, slope, tolerance) &&
		                 (close_to(line_intercept(&line), intercept, tolerance) ||
		                  fabs(line_intercept(&line) - intercept) <= 8 * DBL_EPSILON * terms);
	}
	out->rejected = sums.rejected;
	out->slope = line.slope;
	out->intercept = line_intercept(&line);
}

/* ---- preparation ---- */

static void design_free(struct design *design)
{
	free(design->x);
	free(design->excess);
	free(design->inside);
}

static bp_status design_alloc(size_t n, struct design *design, bp_error *error)
{
	*design = (struct design){.n = n};
	design->x = malloc(n * sizeof *design->x);
	design->excess = malloc(n * sizeof *design->excess);
	design->inside = malloc((n < 2048 ? 2048 : n + 1) * sizeof *design->inside);
	return design->x && design->excess && design->inside ? BP_OK : error_memory(error, n * (2 * sizeof(double) + sizeof(float)));
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
static struct power power_of(int e)
{
	return (struct power){ldexp(1, e / 2), ldexp(1, e - e / 2)};
}

/* Mean, Sxx and leverages of the scaled x. */
static void design_prepare(struct design *design)
{
	const struct kernels *kernels = kernels_get();
	const double *x = design->x, n = (double)design->n;
	const struct robust_sample sample = {x, x, design->excess, design->n};
	struct robust_line line = {x[0], x[0], 0};
	struct robust_sums sums;

	for (size_t i = 0; i < design->n; i++)
		design->excess[i] = 0;
	kernels->robust_sums(&sample, &line, 0, &sums);
	design->mean_x = x[0] + sums.wx / n; /* exact when x is constant */
	line.centre_x = line.centre_y = design->mean_x;
	kernels->robust_sums(&sample, &line, 0, &sums);
	design->sxx = fmax(0, sums.wxx - sums.wx * (sums.wx / n));

	const double inverse = design->sxx > 0 ? 1 / design->sxx : 0, mean = design->mean_x, base = 1 - 1 / n, least = 1 - LEVERAGE_MAX;
	for (size_t i = 0; i < design->n; i++) {
		double d = x[i] - mean, rest = base - d * d * inverse;
		design->excess[i] = (float)(1 / sqrt(rest < least ? least : rest) - 1);
	}
}

/* Undoes the scaling by powers of two. */
static void fit_unscale(struct robust_fit *fit, int x_exponent, int y_exponent)
{
	struct power p = power_of(y_exponent), q = power_of(y_exponent - x_exponent);
	fit->intercept = fit->intercept * p.a * p.b;
	fit->slope = fit->slope * q.a * q.b;
}

bp_status robust_fit(const double *x, const double *y, size_t n, struct robust_fit *out, bp_error *error)
{
	struct design design;
	double *scaled = NULL, largest_x = 0, largest_y = 0;

	if (!n)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "robust regression: no observation");
	if (n == 1) {
		*out = (struct robust_fit){.intercept = y[0], .converged = true};
		return BP_OK;
	}
	bp_status status = design_alloc(n, &design, error);
	if (status)
		goto out;
	scaled = malloc(n * sizeof *scaled);
	if (!scaled) {
		status = error_memory(error, n * sizeof *scaled);
		goto out;
	}
	for (size_t i = 0; i < n; i++) {
		largest_x = fmax(largest_x, fabs(x[i]));
		largest_y = fmax(largest_y, fabs(y[i]));
	}
	design.x_exponent = exponent_of(largest_x);
	const int y_exponent = exponent_of(largest_y);
	const struct power p = power_of(-design.x_exponent), q = power_of(-y_exponent);
	for (size_t i = 0; i < n; i++) {
		design.x[i] = x[i] * p.a * p.b;
		scaled[i] = y[i] * q.a * q.b;
	}
	design_prepare(&design);
	fit_prepared(&design, scaled, out);
	fit_unscale(out, design.x_exponent, y_exponent);
out:
	free(scaled);
	design_free(&design);
	return status;
}

bp_status robust_fit_colour(const struct lattice *lattice, const float *achromatic, double unit, struct colour_fit out[3],
                            bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims), n = lattice->valid_count;
	struct design design;
	double *y = NULL;
	float largest_x = 0;

	if (!n)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "no valid cell");
	bp_status status = design_alloc(n, &design, error);
	if (status)
		goto out;
	y = malloc((n + 1) * sizeof *y);
	if (!y) {
		status = error_memory(error, n * sizeof *y);
		goto out;
	}
	for (size_t i = 0; i < cells; i++) {
		float v = lattice->valid[i] ? fabsf(achromatic[i]) : 0;
		largest_x = v > largest_x ? v : largest_x;
	}
	const int float_exponent = exponent_of((double)largest_x);
	const struct power p = power_of(-float_exponent);
	for (size_t i = 0, k = 0; i < cells && k < n; i++) {
		design.x[k] = (double)achromatic[i] * p.a * p.b;
		k += lattice->valid[i];
	}
	/* The unit enters by its exponent and mantissa, so that it may be of any size. */
	int unit_exponent;
	const double mantissa = frexp(unit, &unit_exponent);
	design.x_exponent = float_exponent + unit_exponent;
	for (size_t k = 0; k < n; k++)
		design.x[k] *= mantissa;
	if (n > 1)
		design_prepare(&design);
	for (int c = 0; c < 3; c++) {
		const double *b = lattice->rgb[c];
		struct robust_fit fit = {0};
		double largest = 0;

		for (size_t i = 0; i < cells; i++) {
			double v = lattice->valid[i] ? b[i] : 0;
			largest = v > largest ? v : largest;
		}
		const int y_exponent = exponent_of(largest);
		const struct power q = power_of(-y_exponent);
		for (size_t i = 0, k = 0; i < cells; i++) {
			y[k] = b[i] * q.a * q.b;
			k += lattice->valid[i];
		}
		if (n == 1)
			fit = (struct robust_fit){.intercept = y[0], .converged = true};
		else
			fit_prepared(&design, y, &fit);
		fit_unscale(&fit, design.x_exponent, y_exponent);
		out[c] = (struct colour_fit){.diffuse = fit.intercept,
		                             .specular = fit.slope,
		                             .iterations = fit.iterations,
		                             .converged = fit.converged,
		                             .rejected = (double)fit.rejected / (double)n};
	}
out:
	free(y);
	design_free(&design);
	return status;
}
