/*
 * robust_valley.c: where the iterations of the regression creep.
 *
 * On measured materials the level of the line settles within a few iterations, while its slope, which a few bright
 * cells decide, creeps on for hundreds: a valley. valley_seek holds the slope t, lets the level v (at x = origin)
 * settle, and looks at the drift that one more iteration gives the slope. It strides along the drift, GROWTH times as
 * far each time, until the drift changes its sign, and closes in on the zero by regula falsi (Illinois). Where it
 * ends, an iteration changes nothing: a fixed point of the very procedure.
 */
#include <math.h>

#include "robust_walk.h"

static const double GROWTH = 4;

struct valley {
	double origin;                   /* x */
	double t, v;                     /* where it stands */
	double tangent;                  /* dv/dt along the valley */
	double low, low_drift;           /* a slope that drifts up, and its drift; 0 where there is none yet */
	double high, high_drift;         /* one that drifts down */
	double stride;                   /* the last one */
	int same_side;                   /* how many zeros in a row fell on the same side */
};

static bool is_bracketed(const struct valley *valley)
{
	return valley->low_drift > 0 && valley->high_drift < 0;
}

/* The next slope to look at, after drift at valley->t. */
static double valley_next(struct valley *valley, double drift)
{
	const bool up = drift > 0;
	double *near = up ? &valley->low : &valley->high, *near_drift = up ? &valley->low_drift : &valley->high_drift;
	double *far_drift = up ? &valley->high_drift : &valley->low_drift;

	*near = valley->t;
	*near_drift = drift;
	/* A bracket shorter than the drift it should explain held a zero at another level: look again. */
	if (is_bracketed(valley) && fabs(valley->high - valley->low) < 0.5 * fabs(drift)) {
		*far_drift = 0;
		valley->stride = 0;
	}
	if (!is_bracketed(valley)) {
		valley->stride = fmax(GROWTH * valley->stride, 2 * fabs(drift));
		return valley->t + (up ? valley->stride : -valley->stride);
	}
	/* Illinois: an end that stays twice loses half its weight. */
	valley->same_side = up ? (valley->same_side > 0 ? valley->same_side + 1 : 1) : (valley->same_side < 0 ? valley->same_side - 1 : -1);
	if (valley->same_side > 1 || valley->same_side < -1)
		*far_drift *= 0.5;
	return valley->low + (valley->high - valley->low) * (valley->low_drift / (valley->low_drift - valley->high_drift));
}

/* Anchors the walk where the bracket is short against the scale: what is left of the search stays within it. */
static void valley_anchor(struct walk *walk, const struct valley *valley)
{
	const double width = fabs(valley->high - valley->low), median = walk->next.median, sway = 0.02;
	const double limit = walk_limit(walk);
	const struct anchor_reach reach = {
		.centre_y = 1.5 * width * (fabs(valley->tangent) + fabs(walk->line.centre_x - valley->origin)) + 1e-3 * median,
		.slope = 1.5 * width,
		.median_low = median * (1 - sway),
		.median_high = median * (1 + sway),
		.limit_low = limit * (1 - sway),
		.limit_high = limit * (1 + sway),
	};

	robust_anchor_place(walk->anchor, &walk->sample, &walk->line, &reach);
}

/* The spread of the x that have weight: a change of slope times it is what residuals change by. */
static double x_spread(const struct robust_sums *s)
{
	return sqrt(fmax(0, s->wxx / s->w - (s->wx / s->w) * (s->wx / s->w)));
}

/*
 * The step with 7 significant bits in terms of the unit. The search magnifies rounding errors; steps rounded so keep it
 * from telling a material from the same in another unit of measure.
 */
static double step_round(double step, double unit)
{
	int e;
	const double m = frexp(step / unit, &e);

	return isfinite(m) && unit > 0 ? ldexp(rint(m * 128), e - 7) * unit : step;
}

bool valley_seek(struct walk *walk, uint32_t evaluations, uint32_t *used)
{
	struct valley valley = {
		.origin = walk->line.centre_x,
		.t = walk->line.slope,
		.v = walk->line.centre_y,
	};
	double last_t = 0, last_v = 0;
	const double level_unit = walk->next.median, slope_unit = level_unit / x_spread(&walk->sums);
	bool settled_once = false, anchored = false;

	*used = 0;
	while (*used < evaluations) {
		double drift = 0, rise = 0, step = 0;

		/* The level settles by secants: alone it may swing. */
		for (int settle = 0; settle < 4 && *used < evaluations; settle++) {
			const struct robust_line from = {valley.origin, valley.v, valley.t};
			const double before = rise;
			walk->line = from;
			walk_step(walk);
			++*used;
			if (line_settled(&from, &walk->line))
				return true;
			drift = walk->line.slope - valley.t;
			rise = walk->line.centre_y + walk->line.slope * (valley.origin - walk->line.centre_x) - valley.v;
			/* Before the zero is bracketed roughly, then well below the drift. */
			const double rough = 0.01 * walk->next.median, fine = 0.5 * fabs(drift) * x_spread(&walk->sums);
			if (fabs(rise) <= (is_bracketed(&valley) ? fmin(rough, fine) : rough))
				settle = 4;
			double gain = settle && settle < 4 ? step / (before - rise) : 1;
			step = step_round(rise * (gain > 0.25 && gain < 4 ? gain : 1), level_unit);
			valley.v += step;
		}
		if (settled_once && valley.t != last_t)
			valley.tangent = (valley.v - last_v) / (valley.t - last_t);
		last_t = valley.t;
		last_v = valley.v;
		settled_once = true;
		valley.t += step_round(valley_next(&valley, drift) - valley.t, slope_unit);
		valley.v += step_round(valley.tangent * (valley.t - last_t), level_unit);
		const bool narrow = is_bracketed(&valley) && fabs(valley.high - valley.low) * x_spread(&walk->sums) < 0.5 * walk->next.median;
		if (narrow && walk->anchor && !anchored) {
			valley_anchor(walk, &valley);
			anchored = true;
		}
	}
	return false;
}
