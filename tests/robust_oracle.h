/*
 * robust_oracle.h: other ways to the regression of robust.h: GSL's, and the same steps written down once more in
 * long double.
 */
#ifndef TESTS_ROBUST_ORACLE_H
#define TESTS_ROBUST_ORACLE_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>

#define ORACLE __attribute__((unused)) static

struct oracle {
	double intercept, slope;
	double step[2]; /* of slow_fit: how far the last iteration moved intercept and slope */
	size_t iterations;
	int status;
};

ORACLE struct oracle gsl_fit(const double *x, const double *y, size_t n)
{
	gsl_matrix *design = gsl_matrix_alloc(n, 2), *cov = gsl_matrix_alloc(2, 2);
	gsl_vector *c = gsl_vector_alloc(2);
	gsl_vector_const_view view = gsl_vector_const_view_array(y, n);
	gsl_multifit_robust_workspace *work = gsl_multifit_robust_alloc(gsl_multifit_robust_bisquare, n, 2);
	gsl_error_handler_t *old = gsl_set_error_handler_off();
	for (size_t i = 0; i < n; i++) {
		gsl_matrix_set(design, i, 0, 1);
		gsl_matrix_set(design, i, 1, x[i]);
	}
	struct oracle out;
	out.status = gsl_multifit_robust(design, &view.vector, c, cov, work);
	out.intercept = gsl_vector_get(c, 0);
	out.slope = gsl_vector_get(c, 1);
	out.iterations = gsl_multifit_robust_statistics(work).numit;
	gsl_set_error_handler(old);
	gsl_multifit_robust_free(work);
	gsl_vector_free(c);
	gsl_matrix_free(cov);
	gsl_matrix_free(design);
	return out;
}

/* -1 to 1 (splitmix64). */
ORACLE long double oracle_draw(uint64_t *random)
{
	uint64_t z = *random += 0x9e3779b97f4a7c15u;
	z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
	z = (z ^ z >> 27) * 0x94d049bb133111ebu;
	return (long double)((z ^ z >> 31) >> 11) * 0x1p-52L - 1;
}

ORACLE int ascending(const void *a, const void *b)
{
	long double x = *(const long double *)a, y = *(const long double *)b;
	return (x > y) - (x < y);
}

ORACLE long double middle(const double *value, size_t n, long double *scratch)
{
	for (size_t i = 0; i < n; i++)
		scratch[i] = value[i];
	qsort(scratch, n, sizeof *scratch, ascending);
	return scratch[n / 2];
}

/*
 * The steps of robust.h written down once more in long double, with a sort for the median. The observations are taken about
 * the medians of x and y: these differences are exact where they are small, so that many nearly equal observations lose
 * nothing by their distance from 0. A constant x has the leverage 1/n; the fitted value is then what counts, and it is
 * returned as intercept with slope 0. Where only observations of one x keep weight, no line is determined: the slope is NaN.
 *
 * With `shake` != 0 every x and y is first moved by up to that part of itself, by numbers drawn from *random: how far the answer
 * then moves tells the condition of the problem.
 */
ORACLE struct oracle slow_fit_shaken(const double *x_in, const double *y_in, size_t n, long double shake, uint64_t *random)
{
	long double *x = malloc(n * sizeof *x), *y = malloc(n * sizeof *y);
	long double *f = malloc(n * sizeof *f), *w = malloc(n * sizeof *w), *v = malloc(n * sizeof *v);
	long double mean_x = 0, mean_y = 0, sxx = 0, syy = 0, a = 0, b = 0;
	const long double from_x = middle(x_in, n, v), from_y = middle(y_in, n, v);
	struct oracle out = {0};
	for (size_t i = 0; i < n; i++) {
		x[i] = (x_in[i] - from_x) + (shake != 0 ? shake * x_in[i] * oracle_draw(random) : 0);
		y[i] = (y_in[i] - from_y) + (shake != 0 ? shake * y_in[i] * oracle_draw(random) : 0);
		mean_x += x[i] / (long double)n;
		mean_y += y[i] / (long double)n;
	}
	for (size_t i = 0; i < n; i++) {
		sxx += (x[i] - mean_x) * (x[i] - mean_x);
		syy += (y[i] - mean_y) * (y[i] - mean_y);
		w[i] = 1;
	}
	int constant = sxx <= 1e-30L * (long double)n * (mean_x + from_x) * (mean_x + from_x);
	for (size_t i = 0; i < n; i++) {
		long double h = 1.0L / (long double)n + (constant ? 0 : (x[i] - mean_x) * (x[i] - mean_x) / sxx);
		f[i] = 1 / sqrtl(1 - (h > 0.9999L ? 0.9999L : h));
	}
	long double least = 1e-6L * sqrtl(syy / (long double)(n - 1));
	if (least == 0)
		least = 1;
	for (out.iterations = 0; out.iterations <= 100; out.iterations++) {
		long double sw = 0, sx = 0, sy = 0, xx = 0, xy = 0, a0 = a, b0 = b, low = INFINITY, high = -INFINITY;
		for (size_t i = 0; i < n; i++) {
			sw += w[i];
			sx += w[i] * x[i];
			sy += w[i] * y[i];
			low = w[i] > 0 ? fminl(low, x_in[i]) : low;
			high = w[i] > 0 ? fmaxl(high, x_in[i]) : high;
		}
		const long double mx = sx / sw, my = sy / sw;
		for (size_t i = 0; i < n; i++) {
			xx += w[i] * (x[i] - mx) * (x[i] - mx);
			xy += w[i] * (x[i] - mx) * (y[i] - my);
		}
		b = constant ? 0 : low < high ? xy / xx : NAN;
		a = (my - b * mx) + (from_y - b * from_x);
		out.step[0] = (double)(a - a0);
		out.step[1] = (double)(b - b0);
		long double tolerance = sqrtl((long double)DBL_EPSILON);
		if (isnan(b) || (out.iterations && fabsl(a - a0) <= tolerance * fmaxl(fabsl(a), fabsl(a0)) &&
		                 fabsl(b - b0) <= tolerance * fmaxl(fabsl(b), fabsl(b0))))
			break;
		for (size_t i = 0; i < n; i++)
			v[i] = fabsl(((y[i] - my) - b * (x[i] - mx)) * f[i]);
		qsort(v, n, sizeof *v, ascending);
		long double s = (v[1 + (n - 2) / 2] + v[1 + (n - 1) / 2]) / 2 / 0.6745L;
		s = fmaxl(s, least);
		for (size_t i = 0; i < n; i++) {
			long double u = ((y[i] - my) - b * (x[i] - mx)) * f[i] / (4.685L * s);
			w[i] = fabsl(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
		}
	}
	out.status = out.iterations > 100;
	out.intercept = (double)a;
	out.slope = (double)b;
	free(x);
	free(y);
	free(f);
	free(w);
	free(v);
	return out;
}

ORACLE struct oracle slow_fit(const double *x, const double *y, size_t n) { return slow_fit_shaken(x, y, n, 0, NULL); }

/*
 * How far a line is from the oracle's at either end of x, relative to the larger of that one's values there: where x is
 * constant only the line's value counts, not its coefficients. Infinite for a line that is not finite.
 */
ORACLE double oracle_deviation(double intercept, double slope, const struct oracle *want, const double *x, size_t n)
{
	double low = x[0], high = x[0], worst = 0;
	if (!isfinite(intercept) || !isfinite(slope))
		return INFINITY;
	for (size_t i = 0; i < n; i++) {
		low = fmin(low, x[i]);
		high = fmax(high, x[i]);
	}
	const double size = fmax(fabs(want->intercept + want->slope * low), fabs(want->intercept + want->slope * high));
	for (int end = 0; end < 2; end++) {
		const double at = end ? high : low;
		worst = fmax(worst, fabs((intercept - want->intercept) + (slope - want->slope) * at) / size);
	}
	return worst;
}

#endif
