/*
 * robust_anchor.h: an iteration of robust.h without reading all observations.
 *
 * Soon the line creeps: steps become small against the scale, often for dozens of iterations. One pass at an
 * *anchor* line (centre_x, c0, b0), which takes as long as two or three iterations, then serves many of them. While the
 * line and the scale stay within a *reach* of the anchor,
 *
 * - an observation whose residual keeps its side of the median need only be counted;
 * - one that stays outside, |u| >= 1, has weight 0;
 * - one that stays inside has the weight (1 - k l^2 r^2)^2 with k = 1/limit^2, l = 1/sqrt(1 - h) and
 *   r = r0 - dc - db t, a polynomial in dc, db and k: its share of the weighted sums follows from moments
 *   sum l^(2q) r0^p t^i that were summed once;
 * - the few that are left, near the median or near |u| = 1, are copied into two lists and read each time.
 *
 * This is algebra, not approximation: the sums are those of the plain pass but for rounding, about 1e-13 of
 * them (tests/test_robust_anchor.c).
 */
#ifndef MODEL_ROBUST_ROBUST_ANCHOR_H
#define MODEL_ROBUST_ROBUST_ANCHOR_H

#include "robust_kernels.h"
#include "brdfpack.h"

struct robust_anchor {
	struct robust_line line;
	struct anchor_reach reach;
	struct anchor_sums sums;
	struct anchor_list near; /* observations that may cross the median */
	struct anchor_list edge; /* those whose weight may become or leave 0 */
	bool placed;
};

/* Room for lists of up to `capacity` observations each, one block at near.x, which is freed with free(). */
bp_status robust_anchor_alloc(size_t capacity, struct robust_anchor *out, bp_error *error);

/* Places the anchor. False, and nothing placed, when the reach is so wide that the lists overflow. */
bool robust_anchor_place(struct robust_anchor *anchor, const struct robust_sample *sample, const struct robust_line *line,
                         const struct anchor_reach *reach);

/* The same line, given about the anchor's centre_x; true when it lies within reach. */
bool robust_anchor_reaches(const struct robust_anchor *anchor, struct robust_line *line);

/* What kernels->robust_sums gives for the whole sample, for a line that reaches, limit in [limit_low, limit_high]. */
void robust_anchor_sums(const struct robust_anchor *anchor, const struct robust_line *line, double limit,
                        struct robust_sums *out);

#endif
