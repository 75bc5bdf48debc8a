#include "robust_walk.h"

#include <float.h>
#include <math.h>

#include "select.h"

static const double TUNING = 4.685, MAD_TO_SIGMA = 0.6745;

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

/* A guess at where the median lies, from ROBUST_PICKS evenly spread observations: four standard errors of rank wide, 2.5 % of them. */
static void guess_bracket(const struct robust_sample *sample, const struct robust_line *line, double *scratch, double *low, double *high)
{
	enum { PICKS = ROBUST_PICKS, MARGIN = 100 };
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

/*
 * The median of |v| over n observations without the smallest: the n - 1 larger values have their middle at ranks
 * 1 + (n-2)/2 and 1 + (n-1)/2 of all. `sample` holds those that are not known to lie below it, `below` of them do.
 */
static double residual_median(const struct kernels *kernels, const struct robust_sample *sample, const struct robust_line *line,
                              size_t n, size_t below, double *inside, struct expectation *next)
{
	const size_t k = 1 + (n - 2) / 2 - below, k2 = 1 + (n - 1) / 2 - below;
	double low, high, median;
	size_t less, count;

	if (next->spread > 0 && next->spread < 0.02) {
		low = next->median * (1 - next->spread);
		high = next->median * (1 + next->spread);
	} else {
		guess_bracket(sample, line, inside, &low, &high);
	}
	count = kernels->robust_scale(sample, line, low, high, inside, &less);
	if (k < less || k2 >= less + count) { /* missed: the same again over the side where it must be */
		double from = k < less ? 0 : k < less + count ? low : high;
		double to = k2 < less ? low : k2 < less + count ? high : DBL_MAX;
		count = kernels->robust_scale(sample, line, from, to, inside, &less);
	}
	median = select_middle(inside, count, k - less, k2 - less);
	/* The change shrinks by a steady factor: twice the last one is a safe guess. */
	next->spread = next->median > 0 ? fmax(1e-4, 2 * fabs(median / next->median - 1)) : 0;
	next->median = median;
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
	const double sxr = s->wxr - s->wr * mean_dx, y = line->centre_y + line->slope * mean_dx + mean_r;
	double sxx = s->wxx - s->wx * mean_dx, x = line->centre_x + mean_dx;

	/*
	 * What is left of a cancellation is noise: where the weighted x are constant it must count as 0, or the slope grows
	 * without bound. True values this small are seen in the next step, about the new centre.
	 */
	if (sxx <= 16 * DBL_EPSILON * s->wxx)
		sxx = 0;
	if (fabs(x) <= 16 * DBL_EPSILON * fabs(mean_dx))
		x = 0;
	const double d0 = balance(s->root), d1 = balance(s->root * fabs(x));
	/* Squared singular values of the balanced columns. */
	const double trace = s->w / (d0 * d0) + (sxx + s->w * x * x) / (d1 * d1);
	const double determinant = (s->w / (d0 * d0)) * (sxx / (d1 * d1));
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

/* ---- the walk ---- */

/* Ordinary least squares, weights 1: first for the mean of y, then about it. */
void walk_start(struct walk *walk)
{
	const struct kernels *kernels = walk->kernels;
	const double *y = walk->sample.y, n = (double)walk->sample.n;
	double syy = 0, rest = 0;

	kernels->robust_sums(&walk->sample, &walk->line, 0, &walk->sums);
	walk->line.centre_y += walk->sums.wr / n;
	for (size_t start = 0; start < walk->sample.n; start += 512) {
		double part = 0;
		for (size_t i = start; i < walk->sample.n && i < start + 512; i++)
			part += (y[i] - walk->line.centre_y) * (y[i] - walk->line.centre_y);
		double t = syy + part;
		rest += syy - t + part;
		syy = t;
	}
	walk->sigma_least = 1e-6 * sqrt((syy + rest) / (n - 1));
	if (!(walk->sigma_least > 0))
		walk->sigma_least = 1;
	kernels->robust_sums(&walk->sample, &walk->line, 0, &walk->sums);
	line_step(&walk->sums, &walk->line);
}

/* One iteration over all observations. */
static void step_plain(struct walk *walk)
{
	const double median =
		residual_median(walk->kernels, &walk->sample, &walk->line, walk->sample.n, 0, walk->inside, &walk->next);

	walk->kernels->robust_sums(&walk->sample, &walk->line, 1 / (TUNING * fmax(median / MAD_TO_SIGMA, walk->sigma_least)),
	                           &walk->sums);
	line_step(&walk->sums, &walk->line);
}

/* The same iteration from the anchor; false, and nothing done, where line or scale are out of its reach. */
static bool step_anchored(struct walk *walk)
{
	const struct robust_anchor *anchor = walk->anchor;
	const struct robust_sample near = {anchor->near.x, anchor->near.y, anchor->near.excess, anchor->near.count};
	const size_t n = walk->sample.n, below = anchor->sums.below;
	struct robust_line line = walk->line;
	struct expectation next = walk->next;

	/* The ranks of residual_median must lie in the list. */
	if (!robust_anchor_reaches(anchor, &line) || 1 + (n - 2) / 2 < below || 1 + (n - 1) / 2 >= below + near.n)
		return false;
	next.spread = fmax(next.spread, 1e-4); /* a guess from evenly spread picks knows nothing of this list */
	if (next.spread >= 0.02)
		return false;
	const double median = residual_median(walk->kernels, &near, &line, n, below, walk->inside, &next);
	const double limit = TUNING * fmax(median / MAD_TO_SIGMA, walk->sigma_least);
	if (median < anchor->reach.median_low || median > anchor->reach.median_high || limit < anchor->reach.limit_low ||
	    limit > anchor->reach.limit_high)
		return false;
	robust_anchor_sums(anchor, &line, limit, &walk->sums);
	line_step(&walk->sums, &line);
	walk->line = line;
	walk->next = next;
	return true;
}

bool walk_anchor(struct walk *walk, const struct robust_line *before, uint32_t iteration)
{
	const double drop = before->centre_y + before->slope * (walk->line.centre_x - before->centre_x);
	const double steps = walk->horizon, median = walk->next.median, sway = fmin(0.25, fmax(steps * walk->next.spread, 1e-4));
	const double limit = TUNING * fmax(median / MAD_TO_SIGMA, walk->sigma_least);
	const struct anchor_reach reach = {
		.centre_y = steps * fabs(walk->line.centre_y - drop),
		.slope = steps * fabs(walk->line.slope - before->slope),
		.median_low = median * (1 - sway),
		.median_high = median * (1 + sway),
		.limit_low = limit * (1 - sway),
		.limit_high = limit * (1 + sway),
	};

	if (robust_anchor_place(walk->anchor, &walk->sample, &walk->line, &reach)) {
		/* Short lists serve more steps for little more each. */
		if (20 * (walk->anchor->near.count + walk->anchor->edge.count) < walk->sample.n)
			walk->horizon *= 2;
		return true;
	}
	walk->horizon *= 0.5;
	if (walk->horizon < 4) { /* still striding: an anchor would cost more than it saves */
		walk->horizon = 8;
		walk->plain_until = iteration + 6;
	}
	return false;
}

void walk_step(struct walk *walk)
{
	if (walk->anchor && walk->anchor->placed && step_anchored(walk))
		return;
	if (walk->anchor)
		walk->anchor->placed = false;
	step_plain(walk);
}

/* |a - b| <= tolerance max(|a|, |b|) */
static bool close_to(double a, double b, double tolerance)
{
	return fabs(a - b) <= tolerance * fmax(fabs(a), fabs(b));
}

bool line_settled(const struct robust_line *from, const struct robust_line *to)
{
	const double tolerance = sqrt(DBL_EPSILON), terms = fabs(to->centre_y) + fabs(to->slope * to->centre_x);

	return close_to(to->slope, from->slope, tolerance) &&
	       (close_to(line_intercept(to), line_intercept(from), tolerance) ||
	        fabs(line_intercept(to) - line_intercept(from)) <= 8 * DBL_EPSILON * terms);
}
