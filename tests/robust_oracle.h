/*
 * robust_oracle.h: other ways to the regression of robust.h: GSL's, and the same steps written down once more in
 * long double.
 */
#ifndef TESTS_ROBUST_ORACLE_H
#define TESTS_ROBUST_ORACLE_H

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>

#define ORACLE __attribute__((unused)) static

struct oracle {
	double intercept, slope;
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

ORACLE int ascending(const void *a, const void *b)
{
	long double x = *(const long double *)a, y = *(const long double *)b;
	return (x > y) - (x < y);
}

/*
 * The steps of robust.h written down once more in long double, with a sort for the median. A constant x has the
 * leverage 1/n; the fitted value is then what counts, and it is returned as intercept with slope 0.
 */
ORACLE struct oracle slow_fit(const double *x, const double *y, size_t n)
{
	long double *f = malloc(n * sizeof *f), *w = malloc(n * sizeof *w), *v = malloc(n * sizeof *v);
	long double mean_x = 0, mean_y = 0, sxx = 0, syy = 0, a = 0, b = 0;
	struct oracle out = {0};
	for (size_t i = 0; i < n; i++) {
		mean_x += x[i] / (long double)n;
		mean_y += y[i] / (long double)n;
	}
	for (size_t i = 0; i < n; i++) {
		sxx += (x[i] - mean_x) * (x[i] - mean_x);
		syy += (y[i] - mean_y) * (y[i] - mean_y);
		w[i] = 1;
	}
	int constant = sxx <= 1e-30L * (long double)n * mean_x * mean_x;
	for (size_t i = 0; i < n; i++) {
		long double h = 1.0L / (long double)n + (constant ? 0 : (x[i] - mean_x) * (x[i] - mean_x) / sxx);
		f[i] = 1 / sqrtl(1 - (h > 0.9999L ? 0.9999L : h));
	}
	long double least = 1e-6L * sqrtl(syy / (long double)(n - 1));
	if (least == 0)
		least = 1;
	for (out.iterations = 0; out.iterations <= 100; out.iterations++) {
		long double sw = 0, sx = 0, sy = 0, xx = 0, xy = 0, a0 = a, b0 = b;
		for (size_t i = 0; i < n; i++) {
			sw += w[i];
			sx += w[i] * x[i];
			sy += w[i] * y[i];
		}
		for (size_t i = 0; i < n; i++) {
			xx += w[i] * (x[i] - sx / sw) * (x[i] - sx / sw);
			xy += w[i] * (x[i] - sx / sw) * (y[i] - sy / sw);
		}
		b = constant ? 0 : xy / xx;
		a = sy / sw - b * (sx / sw);
		long double tolerance = sqrtl((long double)DBL_EPSILON);
		if (out.iterations && fabsl(a - a0) <= tolerance * fmaxl(fabsl(a), fabsl(a0)) &&
		    fabsl(b - b0) <= tolerance * fmaxl(fabsl(b), fabsl(b0)))
			break;
		for (size_t i = 0; i < n; i++)
			v[i] = fabsl((y[i] - a - b * x[i]) * f[i]);
		qsort(v, n, sizeof *v, ascending);
		long double s = (v[1 + (n - 2) / 2] + v[1 + (n - 1) / 2]) / 2 / 0.6745L;
		s = fmaxl(s, least);
		for (size_t i = 0; i < n; i++) {
			long double u = (y[i] - a - b * x[i]) * f[i] / (4.685L * s);
			w[i] = fabsl(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
		}
	}
	out.status = out.iterations > 100;
	out.intercept = (double)a;
	out.slope = (double)b;
	free(f);
	free(w);
	free(v);
	return out;
}

#endif
