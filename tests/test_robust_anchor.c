/* robust_anchor.h: sums from moments and short lists are those of the plain pass over everything. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "model/robust/robust_anchor.h"

enum { N = 20011 }; /* not a multiple of a block or of a vector */
static double xs[N], ys[N];
static double excess[N];
static const struct robust_sample SAMPLE = {xs, ys, excess, N};

static uint64_t state;
static double uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return ((double)(state >> 12) + 0.5) * 0x1p-52;
}

/* Noise in proportion to the value, as in measurements: most points are dark, a few very bright. */
static void make_sample(void)
{
	state = 5;
	for (size_t i = 0; i < N; i++) {
		xs[i] = pow(uniform(), 6);
		ys[i] = 0.01 + 0.8 * xs[i] * (1 + 0.2 * (uniform() - 0.5)) + 0.001 * (uniform() - 0.5);
		excess[i] = (float)(0.02 * xs[i]);
	}
}

static const struct robust_line LINE = {0.05, 0.0501, 0.81, 0};
static const double MEDIAN = 4e-4, LIMIT = 3e-3;

static struct anchor_reach reach_of(double steps)
{
	return (struct anchor_reach){
		.centre_y = steps * 2e-6,
		.slope = steps * 2e-5,
		.median_low = MEDIAN * (1 - 0.01 * steps),
		.median_high = MEDIAN * (1 + 0.01 * steps),
		.limit_low = LIMIT * (1 - 0.01 * steps),
		.limit_high = LIMIT * (1 + 0.01 * steps),
	};
}

static void assert_close(double a, double b, double scale)
{
	if (fabs(a - b) > 1e-12 * scale)
		fail_msg("%.17g is not %.17g", a, b);
}

static void sums_within_reach_are_those_of_the_plain_pass(void **unused)
{
	(void)unused;
	struct robust_anchor anchor;
	const struct anchor_reach reach = reach_of(10);
	make_sample();
	assert_int_equal(robust_anchor_alloc(N + 256, &anchor, NULL), BP_OK);
	assert_true(robust_anchor_place(&anchor, &SAMPLE, &LINE, &reach));
	assert_in_range(anchor.near.count, 1, N / 4);
	assert_in_range(anchor.edge.count, 1, N / 4);
	for (int n = 0; n < 27; n++) {
		/* the corners of the reach (but for rounding), its middle and the middles of its sides */
		const double a = 0.999 * (n % 3 - 1), b = 0.999 * (n / 3 % 3 - 1), c = n / 9 - 1;
		const double limit = c < 0 ? reach.limit_low : c > 0 ? reach.limit_high : LIMIT;
		struct robust_line line = {LINE.centre_x, LINE.centre_y + a * reach.centre_y, LINE.slope + b * reach.slope, 0};
		struct robust_sums plain, fast;
		assert_true(robust_anchor_reaches(&anchor, &line));
		robust_kernels_get()->robust_sums(&SAMPLE, &line, 1 / limit, &plain);
		robust_anchor_sums(&anchor, &line, limit, &fast);
		assert_int_equal(fast.rejected, plain.rejected);
		assert_close(fast.root, plain.root, plain.root);
		assert_close(fast.w, plain.w, plain.w);
		/* sums that cancel are judged by the size of their terms */
		assert_close(fast.wx, plain.wx, sqrt(plain.w * plain.wxx));
		assert_close(fast.wxx, plain.wxx, plain.wxx);
		assert_close(fast.wr, plain.wr, plain.w * limit);
		assert_close(fast.wxr, plain.wxr, sqrt(plain.w * plain.wxx) * limit);
	}
	free(anchor.near.x);
}

static void the_median_is_found_among_the_near_ones(void **unused)
{
	(void)unused;
	struct robust_anchor anchor;
	const struct anchor_reach reach = reach_of(10);
	double *inside = malloc((N + 1) * sizeof *inside);
	size_t less, less_near;
	make_sample();
	assert_non_null(inside);
	assert_int_equal(robust_anchor_alloc(N + 256, &anchor, NULL), BP_OK);
	assert_true(robust_anchor_place(&anchor, &SAMPLE, &LINE, &reach));
	const struct robust_sample near = {anchor.near.x, anchor.near.y, anchor.near.excess, anchor.near.count};
	for (int n = 0; n < 9; n++) {
		const struct robust_line line = {LINE.centre_x, LINE.centre_y + (n % 3 - 1) * reach.centre_y,
		                                 LINE.slope + (n / 3 - 1) * reach.slope, 0};
		for (int m = 0; m < 2; m++) {
			const double at = m ? reach.median_low : reach.median_high;
			robust_kernels_get()->robust_scale(&SAMPLE, &line, at, at, inside, &less);
			robust_kernels_get()->robust_scale(&near, &line, at, at, inside, &less_near);
			assert_int_equal(anchor.sums.below + less_near, less);
		}
	}
	free(inside);
	free(anchor.near.x);
}

static void a_line_out_of_reach_is_told(void **unused)
{
	(void)unused;
	struct robust_anchor anchor;
	const struct anchor_reach reach = reach_of(1);
	make_sample();
	assert_int_equal(robust_anchor_alloc(N + 256, &anchor, NULL), BP_OK);
	assert_true(robust_anchor_place(&anchor, &SAMPLE, &LINE, &reach));
	struct robust_line line = LINE;
	line.slope += 1.01 * reach.slope;
	assert_false(robust_anchor_reaches(&anchor, &line));
	line = LINE;
	line.centre_y -= 1.01 * reach.centre_y;
	assert_false(robust_anchor_reaches(&anchor, &line));
	/* the same line about another centre */
	line = LINE;
	line.centre_x = 7;
	line.centre_y += line.slope * (7 - LINE.centre_x);
	assert_true(robust_anchor_reaches(&anchor, &line));
	free(anchor.near.x);
}

static void a_reach_too_wide_for_the_lists_places_nothing(void **unused)
{
	(void)unused;
	struct robust_anchor anchor;
	const struct anchor_reach reach = reach_of(1000);
	make_sample();
	assert_int_equal(robust_anchor_alloc(1000, &anchor, NULL), BP_OK);
	assert_false(robust_anchor_place(&anchor, &SAMPLE, &LINE, &reach));
	free(anchor.near.x);
}

static void both_tables_of_kernels_give_the_same_bits(void **unused)
{
	(void)unused;
	if (!kernels_avx2_usable())
		skip();
	struct robust_anchor a, b;
	const struct anchor_reach reach = reach_of(10);
	make_sample();
	assert_int_equal(robust_anchor_alloc(N + 256, &a, NULL), BP_OK);
	assert_int_equal(robust_anchor_alloc(N + 256, &b, NULL), BP_OK);
	assert_true(robust_kernels_plain.robust_anchor(&SAMPLE, &LINE, &reach, &a.near, &a.edge, &a.sums));
	assert_true(robust_kernels_avx2.robust_anchor(&SAMPLE, &LINE, &reach, &b.near, &b.edge, &b.sums));
	assert_memory_equal(a.sums.moment, b.sums.moment, sizeof a.sums.moment);
	assert_int_equal(a.sums.below, b.sums.below);
	assert_int_equal(a.sums.outside, b.sums.outside);
	assert_int_equal(a.near.count, b.near.count);
	assert_int_equal(a.edge.count, b.edge.count);
	assert_memory_equal(a.near.x, b.near.x, a.near.count * sizeof *a.near.x);
	assert_memory_equal(a.edge.y, b.edge.y, a.edge.count * sizeof *a.edge.y);
	free(a.near.x);
	free(b.near.x);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(sums_within_reach_are_those_of_the_plain_pass),
		cmocka_unit_test(the_median_is_found_among_the_near_ones),
		cmocka_unit_test(a_line_out_of_reach_is_told),
		cmocka_unit_test(a_reach_too_wide_for_the_lists_places_nothing),
		cmocka_unit_test(both_tables_of_kernels_give_the_same_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
