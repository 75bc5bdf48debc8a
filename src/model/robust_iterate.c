#include "robust_iterate.h"

#include "robust_walk.h"

void robust_iterate(struct design *design, const double *y, struct robust_fit *out)
{
	enum { ANCHOR_FROM = 6 };
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
	}
	out->rejected = walk.sums.rejected;
	out->slope = walk.line.slope;
	out->intercept = line_intercept(&walk.line);
}
