/*
 * robust_walk.h: one iteration of robust.h after another, plain or from an anchor. Internal to it.
 */
#ifndef MODEL_ROBUST_WALK_H
#define MODEL_ROBUST_WALK_H

#include "robust_anchor.h"

enum { ROBUST_PICKS = 8192 };

/* What one iteration expects of the next. */
struct expectation {
	double median, spread; /* the median, and its likely relative change; spread 0: nothing known */
};

/* One regression under way. */
struct walk {
	const struct kernels *kernels;
	struct robust_sample sample;
	double *inside;           /* max(n + 1, ROBUST_PICKS): values gathered around the median */
	double sigma_least;
	struct robust_line line;  /* where it stands */
	struct expectation next;
	struct robust_sums sums;  /* of the last step */
	struct robust_anchor *anchor; /* NULL where there is none */
	double horizon;           /* steps that the next anchor is meant to serve */
	uint32_t plain_until;     /* no anchor before this iteration */
};

/* Ordinary least squares from line = {mean of x, any y, 0}. */
void walk_start(struct walk *walk);
/* One iteration of the procedure: from the anchor where it reaches, else over all observations. */
void walk_step(struct walk *walk);
/* Places an anchor where the walk stands for the steps to come, `before` being where it stood one step ago. */
bool walk_anchor(struct walk *walk, const struct robust_line *before, uint32_t iteration);

static inline double line_intercept(const struct robust_line *line)
{
	return line->centre_y - line->slope * line->centre_x;
}
/* Does the step from one line to the other meet the criterion to stop? */
bool line_settled(const struct robust_line *from, const struct robust_line *to);

#endif
