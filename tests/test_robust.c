/* robust.h against GSL's gsl_multifit_robust, and its own promises. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "model/robust/robust_kernels.h"
#include "model/robust/robust.h"
#include "robust_oracle.h"

static uint64_t state;
static double uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return ((double)(state >> 12) + 0.5) * 0x1p-52;
}
static double normal(void) { return sqrt(-2 * log(uniform())) * cos(6.283185307179586 * uniform()); }

/* Both coefficients within `tolerance` of GSL's, relative to each, or to the size of the terms where a coefficient is 0. */
static void assert_agrees(const double *x, const double *y, size_t n, double tolerance)
{
	struct colour_fit fit;
	double largest_x = 0, largest_y = 0;
	assert_int_equal(robust_fit(x, y, n, &fit, NULL), BP_OK);
	struct oracle want = gsl_fit(x, y, n);
	for (size_t i = 0; i < n; i++) {
		largest_x = fmax(largest_x, fabs(x[i]));
		largest_y = fmax(largest_y, fabs(y[i]));
	}
	double floor_a = 4e-15 * largest_y, floor_b = largest_x > 0 ? 1e-13 * largest_y / largest_x : 0;
	if (fabs(fit.diffuse - want.intercept) > tolerance * fabs(want.intercept) + floor_a ||
	    fabs(fit.specular - want.slope) > tolerance * fabs(want.slope) + floor_b)
		fail_msg("n %zu: ours %.17g %.17g (%u iterations), GSL %.17g %.17g (%zu, status %d)", n, fit.diffuse, fit.specular,
		         fit.iterations, want.intercept, want.slope, want.iterations, want.status);
}

enum { N = 4000 };
static double xs[N], ys[N];

static void make_line(double intercept, double slope, double noise)
{
	state = 7;
	for (size_t i = 0; i < N; i++) {
		xs[i] = exp(normal());
		ys[i] = intercept + slope * xs[i] + noise * normal();
	}
}

static void add_outliers(double share, double size)
{
	for (size_t i = 0; i < N; i++)
		if (uniform() < share)
			ys[i] += size * (1 + uniform());
}

static void scale(double fx, double fy)
{
	for (size_t i = 0; i < N; i++) {
		xs[i] *= fx;
		ys[i] *= fy;
	}
}

static void clean_data_agrees_with_gsl(void **user)
{
	(void)user;
	make_line(0.3, 1.7, 0.1);
	assert_agrees(xs, ys, N, 1e-9);
	make_line(0.3, 1.7, 0);
	assert_agrees(xs, ys, N, 1e-9);
}

static void thirty_percent_outliers_agree_with_gsl(void **user)
{
	(void)user;
	make_line(0.3, 1.7, 0.1);
	add_outliers(0.3, 50);
	assert_agrees(xs, ys, N, 1e-7);
	make_line(-2, 0.5, 1);
	add_outliers(0.3, 8);
	assert_agrees(xs, ys, N, 1e-7);
}

static void nearly_half_outliers_agree_with_gsl(void **user)
{
	(void)user;
	make_line(0.3, 1.7, 0.1);
	add_outliers(0.49, 100);
	assert_agrees(xs, ys, N, 1e-6);
}

static void tiny_and_huge_scales_agree_with_gsl(void **user)
{
	(void)user;
	static const double factors[][2] = {{1e-12, 1e-12}, {1e12, 1e12}, {1, 1e-12}, {1, 1e12}, {1e-12, 1}, {1e12, 1}};
	for (size_t k = 0; k < sizeof factors / sizeof *factors; k++) {
		make_line(0.3, 1.7, 0.1);
		add_outliers(0.3, 50);
		scale(factors[k][0], factors[k][1]);
		assert_agrees(xs, ys, N, 1e-7);
	}
}

/*
 * With a constant x, GSL's leverages are those of an arbitrary second singular vector (single observations lose
 * their weight in it) and its rank test depends on rounding errors; ours are 1/n, as the design has rank 1. What
 * must agree: the robust mean with the reference, and where GSL sees the rank, how it is split in two.
 */
static void a_constant_x_splits_the_robust_mean_as_gsl_does(void **user)
{
	(void)user;
	static const double values[] = {1, 0.3, 1000, 1e-12, 1e12, -7, 0};
	for (size_t k = 0; k < sizeof values / sizeof *values; k++)
		for (size_t n = 50; n <= N; n *= 4) {
			struct colour_fit fit;
			make_line(0.3, 1.7, 0.1);
			for (size_t i = 0; i < N; i++)
				xs[i] = values[k];
			assert_int_equal(robust_fit(xs, ys, n, &fit, NULL), BP_OK);
			struct oracle slow = slow_fit(xs, ys, n), gsl = gsl_fit(xs, ys, n);
			double level = fit.diffuse + fit.specular * values[k];
			assert_true(fabs(level - slow.intercept) <= 1e-9 * slow.intercept);
			if (n > 50 || k > 1)
				continue;
			double share = fit.specular * values[k] / level,
				   gsl_share = gsl.slope * values[k] / (gsl.intercept + gsl.slope * values[k]);
			assert_true(fabs(share - gsl_share) <= 1e-6);
			for (size_t i = 0; i < n; i++)
				ys[i] = 3;
			assert_agrees(xs, ys, n, 1e-6);
		}
}

static void the_reference_in_long_double_agrees(void **user)
{
	(void)user;
	for (unsigned share = 0; share < 5; share++) {
		make_line(0.3, 1.7, 0.1);
		add_outliers(0.1 * share, 30);
		struct colour_fit fit;
		assert_int_equal(robust_fit(xs, ys, N, &fit, NULL), BP_OK);
		struct oracle slow = slow_fit(xs, ys, N);
		assert_true(fabs(fit.diffuse - slow.intercept) <= 1e-9 * fabs(slow.intercept));
		assert_true(fabs(fit.specular - slow.slope) <= 1e-9 * fabs(slow.slope));
		assert_int_equal(fit.iterations, slow.iterations);
	}
}

static void a_constant_y_gives_slope_zero(void **user)
{
	(void)user;
	static const double values[] = {5, 0.1, 1e-12, 1e12, 0};
	for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
		struct colour_fit fit;
		make_line(0, 1, 0);
		for (size_t i = 0; i < N; i++)
			ys[i] = values[k];
		assert_agrees(xs, ys, N, 1e-6);
		assert_int_equal(robust_fit(xs, ys, N, &fit, NULL), BP_OK);
		assert_true(fit.specular == 0 && fit.diffuse == values[k]);
		assert_true(fit.converged && fit.rejected == 0);
	}
}

static void ties_in_the_residuals_agree_with_gsl(void **user)
{
	(void)user;
	/* More than half of the observations lie exactly on a line: the median residual sinks to 0. */
	make_line(0, 1, 0);
	for (size_t i = 0; i < N; i++) {
		xs[i] = (double)(i % 16);
		ys[i] = 2 + 0.5 * xs[i] + (i % 5 == 0 ? (double)(i % 7) : 0);
	}
	assert_agrees(xs, ys, N, 1e-6);
	for (size_t i = 0; i < N; i++)
		ys[i] = i % 3 == 0;
	assert_agrees(xs, ys, N, 1e-6);
}

static void a_large_common_offset_agrees_with_gsl(void **user)
{
	(void)user;
	make_line(0.3, 1.7, 0.1);
	add_outliers(0.2, 20);
	for (size_t i = 0; i < N; i++)
		xs[i] += 1e5;
	assert_agrees(xs, ys, N, 1e-6);
}

static void a_few_observations_agree_with_gsl(void **user)
{
	(void)user;
	for (size_t n = 2; n <= 12; n++)
		for (unsigned seed = 1; seed <= 20; seed++) {
			state = seed * 1000 + n;
			for (size_t i = 0; i < n; i++) {
				xs[i] = uniform();
				ys[i] = 1 + 2 * xs[i] + 0.1 * normal();
			}
			/* With so few, some samples never settle; GSL's answer counts where it converged. */
			if (gsl_fit(xs, ys, n).status == GSL_SUCCESS)
				assert_agrees(xs, ys, n, 1e-6);
		}
}

static void weights_that_leave_a_constant_x_keep_the_line_in_bounds(void **user)
{
	(void)user;
	/* Most of x is 0; the rest soon has no weight, and then nothing determines the slope. */
	for (unsigned seed = 1; seed <= 200; seed++) {
		struct colour_fit fit;
		size_t n = 100 + 7 * seed;
		double step = 1 + (double)seed / 77;
		state = seed;
		for (size_t i = 0; i < n; i++) {
			bool apart = i % 5 == 4;
			xs[i] = apart ? 0.2 * (1 + (seed % 2 ? uniform() : 0)) : 0;
			ys[i] = apart ? 0.43 + (i % 2 ? 0.1 : -0.1) * (1 + uniform()) : 0.43 + 1e-5 * step * (double)(i % 3);
		}
		assert_int_equal(robust_fit(xs, ys, n, &fit, NULL), BP_OK);
		assert_true(fabs(fit.diffuse - 0.44) < 0.01);
		assert_true(fabs(fit.specular) < 1000);
	}
}

/*
 * Nearly all of x is within 1e-5 of 20, in steps of single precision, and what decides the slope is what little differs there:
 * the iterations arrive from bright observations far away, and the residuals become 1e-10 of the values.
 */
static void a_crowd_far_from_zero_is_fitted_to_the_last_digits(void **user)
{
	(void)user;
	double worst = 0;
	for (unsigned seed = 1; seed <= 60; seed++) {
		enum { SIDE = 8, CELLS = SIDE * SIDE * SIDE };
		struct colour_fit fit;
		state = seed;
		uniform();
		const double width = 0.02 + 0.06 * uniform();
		for (int falling = 0; falling < 2; falling++) {
			for (size_t i = 0; i < CELLS; i++) {
				const double h = (double)(i / SIDE / SIDE) / SIDE, d = (double)(i / SIDE % SIDE) / SIDE,
							 p = (double)(i % SIDE) / SIDE;
				const double lobe =
					exp(-h * h * h * h / (width * width)) * (1 + 3 * pow(d, 5)) * (1 + 0.2 * d * cos(6.283185307179586 * p));
				const double value = 0.1 + 5 * lobe, rest = fmax(0, 20 - value);
				xs[i] = (double)(float)(value + rest + value * value);
				ys[i] = falling ? rest : value;
			}
			assert_int_equal(robust_fit(xs, ys, CELLS, &fit, NULL), BP_OK);
			const struct oracle slow = slow_fit(xs, ys, CELLS);
			uint64_t random = seed;
			double moved = 0; /* the line, by half a unit of the observations' last places */
			for (int trial = 0; trial < 4; trial++) {
				const struct oracle shaken = slow_fit_shaken(xs, ys, CELLS, 0x1p-53L, &random);
				if (isfinite(shaken.slope))
					moved = fmax(moved, oracle_deviation(shaken.intercept, shaken.slope, &slow, xs, CELLS));
			}
			if (!slow.status && isfinite(slow.slope)) /* where only one x is left, nothing determines a line */
				worst = fmax(worst, oracle_deviation(fit.diffuse, fit.specular, &slow, xs, CELLS) / fmax(1e-14, 4 * moved));
		}
	}
	assert_true(worst <= 1);
}

/* Half of all is exactly 0: the intercept sinks to rounding errors while the slope still moves. */
static void an_intercept_of_next_to_nothing_does_not_end_the_iterations_early(void **user)
{
	(void)user;
	double worst = 0;
	for (unsigned seed = 1; seed <= 200; seed++) {
		const size_t n = 64 + 3 * seed;
		struct colour_fit fit;
		state = seed;
		uniform();
		const double width = 0.02 + 0.3 * uniform();
		for (size_t i = 0; i < n; i++) {
			const double h = (double)(i * 8 / n) / 8, d = (double)(i % 8) / 8;
			const double value = uniform() < 0.5 ? 0 : 0.1 + 5 * exp(-h * h * h * h / (width * width)) * (1 + 3 * pow(d, 5));
			xs[i] = (double)(float)(1.9 * value + (value > 0 ? 0.07 : 0));
			ys[i] = 0.6 * value + (value > 0 ? 0.02 : 0);
		}
		assert_int_equal(robust_fit(xs, ys, n, &fit, NULL), BP_OK);
		const struct oracle slow = slow_fit(xs, ys, n);
		/* The reference itself still moves where it stops. */
		const double step = oracle_deviation(slow.intercept - slow.step[0], slow.slope - slow.step[1], &slow, xs, n);
		if (!slow.status && isfinite(slow.slope))
			worst = fmax(worst, oracle_deviation(fit.diffuse, fit.specular, &slow, xs, n) -
			                        (fit.iterations == slow.iterations ? 0 : 4 * step));
	}
	assert_true(worst <= 1e-12);
}

/* The mean of the many is 0: the line sinks to it as far as numbers go, and where it stops would follow the unit of measure. */
static void a_channel_that_is_mostly_dark_has_a_line_of_zero(void **user)
{
	(void)user;
	struct lattice l;
	struct colour_fit colour;
	float model[512];
	assert_int_equal(lattice_alloc((struct lattice_dims){8, 8, 8}, &l, NULL), BP_OK);
	for (unsigned seed = 1; seed <= 40; seed++) {
		state = seed;
		for (size_t i = 0; i < 512; i++) {
			const bool dark = uniform() < 0.75;
			model[i] = (float)(0.1 + uniform());
			for (int c = 0; c < 3; c++)
				l.rgb[c][i] = dark ? (seed % 2 ? DBL_TRUE_MIN : 0) : uniform() + 0.1;
		}
		lattice_validate(&l);
		for (int c = 0; c < 3; c++) {
			assert_int_equal(robust_fit_channel(&l, c, model, 0.7, &colour, NULL), BP_OK);
			assert_true(colour.diffuse == 0 && colour.specular == 0 && colour.converged);
		}
	}
	lattice_free(&l);
}

static void one_observation_is_its_own_intercept(void **user)
{
	(void)user;
	double x = 3, y = 4;
	struct colour_fit fit;
	assert_int_equal(robust_fit(&x, &y, 1, &fit, NULL), BP_OK);
	assert_true(fit.diffuse == 4 && fit.specular == 0 && fit.converged);
	assert_int_equal(robust_fit(&x, &y, 0, &fit, NULL), BP_ERROR_ARGUMENT);
}

static void the_ends_of_the_range_of_double_are_fitted(void **user)
{
	(void)user;
	static const double factors[][2] = {{1e300, 1e300}, {1e-300, 1e-300}, {1e-300, 1}, {1, 1e300}};
	make_line(0.3, 1.7, 0.1);
	add_outliers(0.3, 50);
	struct colour_fit plain;
	assert_int_equal(robust_fit(xs, ys, N, &plain, NULL), BP_OK);
	for (size_t k = 0; k < sizeof factors / sizeof *factors; k++) {
		struct colour_fit fit;
		make_line(0.3, 1.7, 0.1);
		add_outliers(0.3, 50);
		scale(factors[k][0], factors[k][1]);
		assert_int_equal(robust_fit(xs, ys, N, &fit, NULL), BP_OK);
		assert_true(fabs(fit.diffuse / factors[k][1] - plain.diffuse) < 1e-9);
		assert_true(fabs(fit.specular * factors[k][0] / factors[k][1] - plain.specular) < 1e-9);
		assert_true(fit.rejected == plain.rejected);
	}
}

/* The count of zero weights, worked out from the answer. */
static void the_rejected_share_is_what_the_weights_say(void **user)
{
	(void)user;
	make_line(0, 1, 0.1);
	add_outliers(0.3, 1000);
	struct colour_fit fit;
	size_t far = 0;
	assert_int_equal(robust_fit(xs, ys, N, &fit, NULL), BP_OK);
	for (size_t i = 0; i < N; i++)
		far += fabs(ys[i] - fit.diffuse - fit.specular * xs[i]) > 100;
	const size_t rejected = (size_t)lround(fit.rejected * N);
	assert_true(rejected >= far && rejected < far + N / 100);
	assert_true(fit.converged && fit.iterations > 1 && fit.iterations < 100);
}

static void a_large_sample_takes_the_bracketed_median_and_still_agrees_with_gsl(void **user)
{
	(void)user;
	enum { MANY = 60000 };
	double *x = malloc(MANY * sizeof *x), *y = malloc(MANY * sizeof *y);
	state = 99;
	for (size_t i = 0; i < MANY; i++) {
		x[i] = exp(2 * normal());
		y[i] = 0.01 + 1.2 * x[i] * (1 + 0.1 * normal()) + 0.001 * normal();
	}
	assert_agrees(x, y, MANY, 1e-6);
	for (size_t i = 0; i < MANY; i++) /* many ties, and few different residuals */
		y[i] = floor(4 * uniform()) + (double)(i % 2) * x[i];
	if (gsl_fit(x, y, MANY).status == GSL_SUCCESS)
		assert_agrees(x, y, MANY, 1e-6);
	free(x);
	free(y);
}

/*
 * The bright few follow a line of another slope than the many, with a gradual change between: the iterations creep
 * from one to the other, from anchors. They must take GSL's steps, also where both end at the limit of 100.
 */
static void a_creeping_slope_takes_the_steps_of_gsl(void **user)
{
	(void)user;
	enum { MANY = 40000 };
	double *x = malloc(MANY * sizeof *x), *y = malloc(MANY * sizeof *y);
	state = 1;
	for (size_t i = 0; i < MANY; i++) {
		x[i] = exp(2.5 * normal());
		y[i] = x[i] * (1 + 0.5 * x[i] / (x[i] + 3)) + 0.002 * normal();
	}
	struct colour_fit fit;
	assert_int_equal(robust_fit(x, y, MANY, &fit, NULL), BP_OK);
	assert_true(fit.iterations > 50);
	assert_agrees(x, y, MANY, 1e-6);
	free(x);
	free(y);
}

static void both_kernel_tables_give_the_same_bits(void **user)
{
	(void)user;
	if (!kernels_avx2_usable())
		skip();
	make_line(0.3, 1.7, 0.1);
	add_outliers(0.3, 50);
	static double excess[N];
	static double a[N + 1], b[N + 1];
	for (size_t i = 0; i < N; i++)
		excess[i] = (float)(1e-3 * uniform());
	for (size_t n = N - 19; n <= N; n++) {
		const struct robust_sample sample = {xs, ys, excess, n};
		const struct robust_line line = {1.5, 2.9, 1.6, n % 2 ? 0 : 1e-17};
		struct robust_sums p, q;
		size_t below_a, below_b;
		robust_kernels_plain.robust_sums(&sample, &line, 0.7, &p);
		robust_kernels_avx2.robust_sums(&sample, &line, 0.7, &q);
		assert_memory_equal(&p, &q, sizeof p);
		size_t count_a = robust_kernels_plain.robust_scale(&sample, &line, 0.1, 0.2, a, &below_a);
		size_t count_b = robust_kernels_avx2.robust_scale(&sample, &line, 0.1, 0.2, b, &below_b);
		assert_true(count_a == count_b && below_a == below_b);
		assert_memory_equal(a, b, count_a * sizeof *a);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(clean_data_agrees_with_gsl),
		cmocka_unit_test(thirty_percent_outliers_agree_with_gsl),
		cmocka_unit_test(nearly_half_outliers_agree_with_gsl),
		cmocka_unit_test(tiny_and_huge_scales_agree_with_gsl),
		cmocka_unit_test(a_constant_x_splits_the_robust_mean_as_gsl_does),
		cmocka_unit_test(the_reference_in_long_double_agrees),
		cmocka_unit_test(a_constant_y_gives_slope_zero),
		cmocka_unit_test(ties_in_the_residuals_agree_with_gsl),
		cmocka_unit_test(a_large_common_offset_agrees_with_gsl),
		cmocka_unit_test(a_few_observations_agree_with_gsl),
		cmocka_unit_test(weights_that_leave_a_constant_x_keep_the_line_in_bounds),
		cmocka_unit_test(a_crowd_far_from_zero_is_fitted_to_the_last_digits),
		cmocka_unit_test(an_intercept_of_next_to_nothing_does_not_end_the_iterations_early),
		cmocka_unit_test(a_channel_that_is_mostly_dark_has_a_line_of_zero),
		cmocka_unit_test(one_observation_is_its_own_intercept),
		cmocka_unit_test(the_ends_of_the_range_of_double_are_fitted),
		cmocka_unit_test(the_rejected_share_is_what_the_weights_say),
		cmocka_unit_test(a_large_sample_takes_the_bracketed_median_and_still_agrees_with_gsl),
		cmocka_unit_test(a_creeping_slope_takes_the_steps_of_gsl),
		cmocka_unit_test(both_kernel_tables_give_the_same_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
