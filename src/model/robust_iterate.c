#include "robust_iterate.h"

#include <math.h>

#include "robust_walk.h"

/* How the steps have gone of late. */
struct progress {
	double stride[5]; /* lengths of the last steps, by iteration modulo 5 */
	unsigned creeps;  /* iterations in a row without progress */
};

/*
 * Do the steps fail to shrink? What converges at a rate of 0.87 or better halves them within five, and is left to itself.
 * Four failures in a row from the tenth iteration on are a creep.
 */
static bool is_creeping(struct progress *progress, uint32_t iteration, double stride)
{
	double *before = &progress->stride[iteration % 5];

	progress->creeps = iteration >= 7 && stride > 0.5 * *before ? progress->creeps + 1 : 0;
	*before = stride;
	return progress->creeps >= 4;
}

void robust_iterate(struct design *design, const double *y, struct robust_fit *out)
{
	enum { ANCHOR_FROM = 12 };
	struct walk walk = {
		.kernels = kernels_get(),
		.sample = {design->x, y, design->excess, design->n},
		.inside = design->inside,
		.line = {design->mean_x, y[0], 0},
		.anchor = design->anchor.near.capacity ? &design->anchor : NULL,
		.horizon = 8,
		.plain_until = ANCHOR_FROM,
	};
	struct robust_line before = walk.line;
	struct progress progress = {{0}, 0};

	walk_start(&walk);
	design->anchor.placed = false;
	out->converged = false;
	out->iterations = 0;
	while (!out->converged && out->iterations < ROBUST_ITERATIONS_MAX) {
		const struct robust_line from = walk.line;

		if (walk.anchor && !walk.anchor->placed && out->iterations >= walk.plain_until)
			walk_anchor(&walk, &before, out->iterations);
		walk_step(&walk);
		out->iterations++;
		before = from;

		out->converged = line_settled(&from, &walk.line);
		if (walk.anchor && !out->converged && is_creeping(&progress, out->iterations, fabs(walk.line.slope - from.slope))) {
			uint32_t used;
			walk.anchor->placed = false;
			out->converged = valley_seek(&walk, ROBUST_ITERATIONS_MAX - out->iterations, &used);
			out->iterations += used;
			break;
		}
	}
	out->rejected = walk.sums.rejected;
	out->slope = walk.line.slope;
	out->intercept = line_intercept(&walk.line);
}
