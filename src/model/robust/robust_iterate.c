#include "robust_iterate.h"

#include "robust_walk.h"

/* Copies the picks: where they stand, every one would be a cache miss each time. */
static struct robust_sample picks_copy(struct design *design)
{
	const size_t count = robust_picks(design->n);
	double *picked_x = design->picked, *picked_y = design->picked + count;

	for (size_t k = 0; k < count; k++) {
		const size_t i = k * design->n / count;
		picked_x[k] = design->x[i];
		picked_y[k] = design->y[i];
		design->picked_excess[k] = design->excess[i];
	}
	return (struct robust_sample){picked_x, picked_y, design->picked_excess, count};
}

void robust_iterate(struct design *design, uint32_t limit, struct robust_fit *out)
{
	struct walk walk = {
		.kernels = robust_kernels_get(),
		.sample = {design->x, design->y, design->excess, design->n},
		.picks = picks_copy(design),
		.inside = design->inside,
		.line = {design->mean_x, design->y[0], 0, 0},
		.anchor = design->anchor.near.capacity ? &design->anchor : NULL,
	};

	walk_start(&walk);
	design->anchor.placed = false;
	out->converged = false;
	out->iterations = 0;
	while (!out->converged && out->iterations < limit) {
		out->iterations++;
		walk_step(&walk, limit - out->iterations);
		out->converged = line_settled(&walk.before, &walk.line);
	}
	out->rejected = walk.sums.rejected;
	out->slope = walk.line.slope;
	out->intercept = line_intercept(&walk.line);
}
