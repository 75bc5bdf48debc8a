#include "robust_anchor.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"

bp_status robust_anchor_alloc(size_t capacity, struct robust_anchor *out, bp_error *error)
{
	const size_t bytes = 6 * capacity * sizeof(double);
	double *block = malloc(bytes);

	if (!block)
		return error_memory(error, bytes);
	*out = (struct robust_anchor){
		.near = {block, block + capacity, block + 2 * capacity, 0, capacity},
		.edge = {block + 3 * capacity, block + 4 * capacity, block + 5 * capacity, 0, capacity},
	};
	return BP_OK;
}

bool robust_anchor_place(struct robust_anchor *anchor, const struct robust_sample *sample, const struct robust_line *line,
                         const struct anchor_reach *reach)
{
	anchor->line = *line;
	anchor->reach = *reach;
	anchor->placed = robust_kernels_get()->robust_anchor(sample, line, reach, &anchor->near, &anchor->edge, &anchor->sums);
	return anchor->placed;
}

bool robust_anchor_reaches(const struct robust_anchor *anchor, struct robust_line *line)
{
	line->centre_y += line->slope * (anchor->line.centre_x - line->centre_x);
	line->centre_x = anchor->line.centre_x;
	return fabs(line->centre_y - anchor->line.centre_y) <= anchor->reach.centre_y &&
	       fabs(line->slope - anchor->line.slope) <= anchor->reach.slope;
}

/* Sum of l^(2q) t^a r^e over the observations inside, r = r0 - dc - db t: the binomial expansion over the moments. */
static double inside_sum(const struct anchor_sums *sums, int q, int a, int e, double dc, double db)
{
	static const double binomial[6][6] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}, {1, 5, 10, 10, 5, 1}};
	double total = 0, power_b = 1;
	for (int i = 0; i <= e; i++, power_b *= -db) {
		double part = 0, power_c = 1;
		for (int j = 0; i + j <= e; j++, power_c *= -dc)
			part += binomial[e - i][j] * power_c * sums->moment[q][e - i - j][a + i];
		total += binomial[e][i] * power_b * part;
	}
	return total;
}

void robust_anchor_sums(const struct robust_anchor *anchor, const struct robust_line *line, double limit, struct robust_sums *out)
{
	const struct anchor_sums *inside = &anchor->sums;
	const struct robust_sample edge = {anchor->edge.x, anchor->edge.y, anchor->edge.excess, anchor->edge.count};
	const double dc = line->centre_y - anchor->line.centre_y, db = line->slope - anchor->line.slope;
	const double k = 1 / (limit * limit);
	const struct {
		double *sum;
		int a, e; /* of w t^a r^e */
	} wanted[] = {{&out->w, 0, 0}, {&out->wx, 1, 0}, {&out->wxx, 2, 0}, {&out->wr, 0, 1}, {&out->wxr, 1, 1}};

	robust_kernels_get()->robust_sums(&edge, line, 1 / limit, out);
	out->rejected += inside->outside;
	out->root += inside_sum(inside, 0, 0, 0, dc, db) - k * inside_sum(inside, 1, 0, 2, dc, db);
	for (size_t n = 0; n < sizeof wanted / sizeof *wanted; n++) {
		const int a = wanted[n].a, e = wanted[n].e;
		*wanted[n].sum += inside_sum(inside, 0, a, e, dc, db) - 2 * k * inside_sum(inside, 1, a, e + 2, dc, db) +
		                  k * k * inside_sum(inside, 2, a, e + 4, dc, db);
	}
}
