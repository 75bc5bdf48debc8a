#include "robust_walk.h"

#include <float.h>
#include <math.h>

#include "model/math/select.h"

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

/* A guess at where the median lies, from the picks: four standard errors of rank wide; scratch holds one value of each. */
static void guess_bracket(const struct robust_sample *picks, const struct robust_line *line, double *scratch, double *low,
                          double *high)
{
	if (!picks->n) {
		*low = 0;
		*high = DBL_MAX;
		return;
	}
	const size_t margin = (size_t)(1.1 * sqrt((double)picks->n)), first = picks->n / 2 - margin;
	for (size_t k = 0; k < picks->n; k++) {
		double r = (picks->y[k] - line->centre_y) - line->slope * (picks->x[k] - line->centre_x);
		scratch[k] = fabs(r + r * (double)picks->excess[k]);
	}
	*low = select_kth(scratch, picks->n, first);
	*high = select_kth(scratch + first, picks->n - first, 2 * margin); /* nothing smaller is behind first */
}

/*
 * The median of |v| over all n observations without the smallest: the n - 1 larger values have their middle at ranks
 * 1 + (n-2)/2 and 1 + (n-1)/2 of all. `sample` holds those that are not known to lie below it, `below` of them do. What was
 * expected is used where it is known to `widest`; walk->next becomes what to expect next time.
 */
static double residual_median(struct walk *walk, const struct robust_sample *sample, const struct robust_line *line, size_t below,
                              double widest)
{
	const struct robust_kernels *kernels = walk->kernels;
	struct expectation *next = &walk->next;
	const size_t n = walk->sample.n, k = 1 + (n - 2) / 2 - below, k2 = 1 + (n - 1) / 2 - below;
	double low, high, median, *inside = walk->inside;
	size_t less, count;

	if (next->spread > 0 && next->spread < widest) {
		low = next->median * (1 - next->spread);
		high = next->median * (1 + next->spread);
	} else {
		guess_bracket(&walk->picks, line, inside, &low, &high);
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

/* The place a step of mean_dx leads to. */
static double centre_moved(double centre_x, double mean_dx)
{
	const double x = centre_x + mean_dx;
	return fabs(x) <= 16 * DBL_EPSILON * fabs(mean_dx) ? 0 : x; /* what is left of a cancellation is noise */
}

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
 * do not span a line, to the solution of least balanced norm. Returns what the new centre_y, and centre_x by way of
 * the slope, lack through rounding.
 */
static double line_step(const struct robust_sums *s, struct robust_line *line)
{
	const struct robust_line from = *line;
	const double mean_dx = s->wx / s->w, mean_r = s->wr / s->w;
	const double sxr = s->wxr - s->wr * mean_dx, y = line->centre_y + line->slope * mean_dx + mean_r;
	double sxx = s->wxx - s->wx * mean_dx;
	const double x = centre_moved(line->centre_x, mean_dx);

	/* What a cancellation leaves is noise: where the weighted x are constant it counts as 0, or the slope grows without bound. */
	if (sxx <= 16 * DBL_EPSILON * s->wxx)
		sxx = 0;
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
	const double missed = (x - from.centre_x) - mean_dx; /* the line passes beside x, through the weighted mean */
	const double step = from.slope * mean_dx + mean_r + line->slope * missed + from.rest_y;
	line->rest_y = 0;
	return (from.centre_y - y) + step;
}

/* ---- the walk ---- */

/* Ordinary least squares, weights 1: first for the mean of y, then about it. */
void walk_start(struct walk *walk)
{
	const struct robust_kernels *kernels = walk->kernels;
	const double *y = walk->sample.y, n = (double)walk->sample.n;
	double syy = 0, rest = 0;

	kernels->robust_sums(&walk->sample, &walk->line, 0, &walk->sums);
	walk->line.centre_y += walk->sums.wr / n;
	for (size_t start = 0; start < walk->sample.n; start += 512) {
		const size_t end = start + 512 < walk->sample.n ? start + 512 : walk->sample.n;
		double part[4] = {0}; /* each addition waits for the one before */
		size_t i = start;
		for (; i + 4 <= end; i += 4)
			for (size_t l = 0; l < 4; l++)
				part[l] += (y[i + l] - walk->line.centre_y) * (y[i + l] - walk->line.centre_y);
		for (; i < end; i++)
			part[0] += (y[i] - walk->line.centre_y) * (y[i] - walk->line.centre_y);
		const double sum = (part[0] + part[1]) + (part[2] + part[3]), t = syy + sum;
		rest += syy - t + sum;
		syy = t;
	}
	walk->sigma_least = 1e-6 * sqrt((syy + rest) / (n - 1));
	if (!(walk->sigma_least > 0))
		walk->sigma_least = 1;
	kernels->robust_sums(&walk->sample, &walk->line, 0, &walk->sums);
	walk->lack = line_step(&walk->sums, &walk->line);
	walk->careful = false;
}

static double limit_of(const struct walk *walk, double median) { return TUNING * fmax(median / MAD_TO_SIGMA, walk->sigma_least); }

/*
 * Do weights of this limit feel the rounding of the line's centre, half a unit of its last places? Below 2^-37 of the limit they
 * change by as little.
 */
static bool limit_fine(const struct robust_line *line, double limit)
{
	return fabs(line->centre_y) + fabs(line->slope * line->centre_x) > 0x1p16 * limit;
}

/*
 * Do the weighted x lie so far from the centre, against their spread, that Sxx loses digits? So it is where the weights have
 * just left a few bright observations for many dark ones, all nearly the same. A slope that is wrong in its fifth digit would
 * be forgotten only slowly in the steps after.
 */
static bool sums_cancel(const struct robust_sums *s) { return s->wxx - s->wx * (s->wx / s->w) < 0x1p-20 * s->wxx; }

/* The same line about the weighted mean. */
static void line_recentre(struct robust_line *line, double mean_dx, bool careful)
{
	const double x = centre_moved(line->centre_x, mean_dx), step = line->rest_y + line->slope * (x - line->centre_x);
	const double y = line->centre_y + step;

	line->rest_y = careful ? (line->centre_y - y) + step : 0;
	line->centre_x = x;
	line->centre_y = y;
}

/* One iteration over all observations. */
static void step_plain(struct walk *walk)
{
	/* Few values lie within 2 % of the median; of a small sample, more may be gathered for what a guess would cost. */
	const double widest = fmin(fmax(ROBUST_PICKS_MAX / (double)walk->sample.n, 0.02), 0.25);
	double limit = limit_of(walk, residual_median(walk, &walk->sample, &walk->line, 0, widest));

	if (!walk->careful && limit_fine(&walk->line, limit)) {
		walk->careful = true;
		walk->line.rest_y = walk->lack;
		walk->next.spread = 0;
		limit = limit_of(walk, residual_median(walk, &walk->sample, &walk->line, 0, widest));
	}
	walk->kernels->robust_sums(&walk->sample, &walk->line, 1 / limit, &walk->sums);
	if (sums_cancel(&walk->sums)) {
		line_recentre(&walk->line, walk->sums.wx / walk->sums.w, walk->careful);
		walk->kernels->robust_sums(&walk->sample, &walk->line, 1 / limit, &walk->sums);
	}
	walk->lack = line_step(&walk->sums, &walk->line);
	if (walk->careful)
		walk->line.rest_y = walk->lack;
}

/* The same iteration from the anchor; false, and nothing done, where line or scale are out of its reach. */
static bool step_anchored(struct walk *walk)
{
	const struct robust_anchor *anchor = walk->anchor;
	const struct robust_sample near = {anchor->near.x, anchor->near.y, anchor->near.excess, anchor->near.count};
	const size_t n = walk->sample.n, below = anchor->sums.below;
	const struct expectation expected = walk->next;
	struct robust_line line = walk->line;

	/* The ranks of residual_median must lie in the list. */
	if (!robust_anchor_reaches(anchor, &line) || 1 + (n - 2) / 2 < below || 1 + (n - 1) / 2 >= below + near.n)
		return false;
	walk->next.spread = fmin(fmax(expected.spread, 1e-4), 0.25); /* a guess from the picks knows nothing of this list */
	const double median = residual_median(walk, &near, &line, below, 1);
	const double limit = limit_of(walk, median);
	if (median < anchor->reach.median_low || median > anchor->reach.median_high || limit < anchor->reach.limit_low ||
	    limit > anchor->reach.limit_high || limit_fine(&line, limit)) {
		walk->next = expected;
		return false;
	}
	robust_anchor_sums(anchor, &line, limit, &walk->sums);
	if (sums_cancel(&walk->sums)) {
		walk->next = expected;
		return false;
	}
	walk->lack = line_step(&walk->sums, &line);
	walk->line = line;
	return true;
}

/* ---- anchors ---- */

/* What the last step moved: the next ones are expected to move less. */
struct stride {
	double centre_y, slope, spread;
};

/* How far the median may change in so many steps, relative. */
static double sway_of(double spread, double steps) { return fmin(0.25, fmax(steps * spread, 1e-4)); }

static const double HORIZONS[] = {2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96};
enum { HORIZON_COUNT = sizeof HORIZONS / sizeof *HORIZONS };

/*
 * The number of steps an anchor should be meant for, so that its pass and the reading of its lists cost least per step; 0
 * where plain steps cost less. The lists grow with the number; how fast is learnt from every fourth of the picks.
 * Units: a plain step, of which median and sums are half each.
 */
static double horizon_choose(const struct walk *walk, const struct stride *stride, uint32_t left)
{
	static const double PLACING = 2.5;
	const struct robust_sample *picks = &walk->picks;
	const double median = walk->next.median, limit = limit_of(walk, median), looked_at = (double)(picks->n / 4);
	const double room = 0.9 * (double)walk->anchor->near.capacity / (double)walk->sample.n * looked_at;
	uint32_t near[HORIZON_COUNT] = {0}, edge[HORIZON_COUNT] = {0};
	double best = 0.9, chosen = 0;

	for (size_t k = 0; k < picks->n; k += 4) {
		const double t = picks->x[k] - walk->line.centre_x, l = 1 + (double)picks->excess[k];
		const double v = fabs((picks->y[k] - walk->line.centre_y) - walk->line.slope * t) * l;
		const double step = (stride->centre_y + stride->slope * fabs(t)) * l;
		for (int h = 0; h < HORIZON_COUNT; h++) {
			const double sway = sway_of(stride->spread, HORIZONS[h]), reach = HORIZONS[h] * step;
			near[h] += fabs(v - median) <= reach + sway * median;
			edge[h] += fabs(v - limit) <= reach + sway * limit;
		}
	}
	for (int h = 0; h < HORIZON_COUNT; h++) {
		const double lists = 0.5 * (near[h] + edge[h]) / looked_at, steps = fmin(HORIZONS[h], left + 1);
		if (PLACING / steps + lists < best && near[h] < room && edge[h] < room) {
			best = PLACING / steps + lists;
			chosen = HORIZONS[h];
		}
	}
	return chosen;
}

/* Places an anchor where the walk stands for the steps to come; false where that is not worth it. */
static bool anchor_here(struct walk *walk, uint32_t left)
{
	const struct robust_line *line = &walk->line, *before = &walk->before;
	const double drop = before->centre_y + before->slope * (line->centre_x - before->centre_x);
	const struct stride stride = {fabs(line->centre_y - drop), fabs(line->slope - before->slope), walk->next.spread};

	walk->anchor->placed = false;
	if (!(stride.spread > 0)) /* the first steps */
		return false;
	const double steps = horizon_choose(walk, &stride, left), median = walk->next.median, limit = limit_of(walk, median);
	const double sway = sway_of(stride.spread, steps);
	const struct anchor_reach reach = {
		.centre_y = steps * stride.centre_y,
		.slope = steps * stride.slope,
		.median_low = median * (1 - sway),
		.median_high = median * (1 + sway),
		.limit_low = limit * (1 - sway),
		.limit_high = limit * (1 + sway),
	};
	return steps > 0 && robust_anchor_place(walk->anchor, &walk->sample, line, &reach);
}

void walk_step(struct walk *walk, uint32_t left)
{
	const struct robust_line from = walk->line;

	if (!walk->anchor || walk->careful)
		step_plain(walk);
	else if (!(walk->anchor->placed && step_anchored(walk)) && !(anchor_here(walk, left) && step_anchored(walk)))
		step_plain(walk);
	walk->before = from;
}

/* |a - b| <= tolerance max(|a|, |b|) */
static bool close_to(double a, double b, double tolerance) { return fabs(a - b) <= tolerance * fmax(fabs(a), fabs(b)); }

bool line_settled(const struct robust_line *from, const struct robust_line *to)
{
	const double tolerance = sqrt(DBL_EPSILON), rounding = 8 * DBL_EPSILON;
	const double terms = fabs(to->centre_y) + fabs(to->slope * to->centre_x);

	return (close_to(to->slope, from->slope, tolerance) && close_to(line_intercept(to), line_intercept(from), tolerance)) ||
	       (close_to(to->slope, from->slope, rounding) && fabs(line_intercept(to) - line_intercept(from)) <= rounding * terms);
}
