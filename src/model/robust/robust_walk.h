/*
 * robust_walk.h: one iteration of robust.h after another, plain or from an anchor. Internal to it.
 */
#ifndef MODEL_ROBUST_ROBUST_WALK_H
#define MODEL_ROBUST_ROBUST_WALK_H

#include "robust_anchor.h"

/*
 * Some of n observations, evenly spread, tell where to look for the rest: the more of them, the narrower the bracket around
 * the median; 0 of a few. ROBUST_PICKS_MAX is the largest number.
 */
enum { ROBUST_PICKS_MAX = 8192 };
static inline size_t robust_picks(size_t n)
{
	return n >= 1 << 19 ? ROBUST_PICKS_MAX : n >= ROBUST_PICKS_MAX ? ROBUST_PICKS_MAX / 4 : 0;
}

/* What one iteration expects of the next. */
struct expectation {
	double median, spread; /* the median, and its likely relative change; spread 0: nothing known */
};

/* One regression under way. */
struct walk {
	const struct robust_kernels *kernels;
	struct robust_sample sample, picks;
	double *inside; /* n + 1: values gathered around the median */
	double sigma_least;
	struct robust_line line; /* where it stands */
	struct expectation next;
	struct robust_sums sums;      /* of the last step */
	struct robust_line before;    /* and where it stood one step ago */
	double lack;                  /* what rounding took from line.centre_y */
	bool careful;                 /* the residuals are so small that it counts: line.rest_y = lack */
	struct robust_anchor *anchor; /* NULL where there is none */
};

/* Ordinary least squares from line = {mean of x, any y, 0}. */
void walk_start(struct walk *walk);
/*
 * One iteration of the procedure: from an anchor where that costs less than reading all observations. At most `left` more
 * will follow.
 */
void walk_step(struct walk *walk, uint32_t left);

static inline double line_intercept(const struct robust_line *line)
{
	return (line->centre_y - line->slope * line->centre_x) + line->rest_y;
}
/* Does the step from one line to the other meet the criterion to stop? */
bool line_settled(const struct robust_line *from, const struct robust_line *to);

#endif
