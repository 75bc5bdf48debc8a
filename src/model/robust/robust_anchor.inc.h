/* robust_anchor.inc.h: the one pass of robust_anchor.h over all observations. See robust_kernels.h. */
#include <string.h>

enum { ANCHOR_BLOCK = 256, ANCHOR_GROUP = 16 };

/* The observations of one block about the line: dx, residual, 1 + excess; kept = 1 where surely inside, else 0. */
struct KERNEL(anchor_block) {
	double t[ANCHOR_BLOCK], r[ANCHOR_BLOCK], l2[ANCHOR_BLOCK], kept[ANCHOR_BLOCK];
};

/* Adds v r^p for p < count, and multiplies v by t. */
static ALWAYS_INLINE void KERNEL(anchor_powers)(lanes4 *v, const lanes4 *t, const lanes4 *r, int count, lanes4 *sum)
{
	lanes4 u = *v;
	for (int p = 0; p < count; p++, u *= *r)
		sum[p] += u;
	*v *= *t;
}

/*
 * Sums of weight r^p t^i over a block, for i = i0, i0 + 1, i0 + 2 and p below the count of each. Counts are constants, at most 12
 * in all at a time, so that the sums stay in registers.
 */
static ALWAYS_INLINE void KERNEL(anchor_sweep)(const struct KERNEL(anchor_block) *b, const double *weight, int i0, int count0,
                                               int count1, int count2, double (*sum)[ANCHOR_T])
{
	lanes4 s[3][6] = {{{0}}};
	for (size_t n = 0; n < ANCHOR_BLOCK; n += 4) {
		const lanes4 t = LANES_LOAD(b->t + n), r = LANES_LOAD(b->r + n);
		lanes4 v = LANES_LOAD(weight + n);
		for (int i = 0; i < i0; i++)
			v *= t;
		KERNEL(anchor_powers)(&v, &t, &r, count0, s[0]);
		KERNEL(anchor_powers)(&v, &t, &r, count1, s[1]);
		KERNEL(anchor_powers)(&v, &t, &r, count2, s[2]);
	}
	for (int p = 0; p < 6; p++) {
		if (p < count0)
			sum[p][i0] = lanes_sum(&s[0][p]);
		if (p < count1)
			sum[p][i0 + 1] = lanes_sum(&s[1][p]);
		if (p < count2)
			sum[p][i0 + 2] = lanes_sum(&s[2][p]);
	}
}

/* Copies the observations of one group that are flagged to the list, which has room. */
static inline void KERNEL(anchor_copy)(struct anchor_list *list, const double *x, const double *y, const double *excess,
                                       const int64_t *flag)
{
	size_t count = list->count;
	for (size_t i = 0; i < ANCHOR_GROUP; i++) {
		list->x[count] = x[i];
		list->y[count] = y[i];
		list->excess[count] = excess[i];
		count += (size_t)(flag[i] & 1);
	}
	list->count = count;
}

/* Adds a block's sums to the totals, whose rounding errors gather in rest (Knuth's two-sum: no branch). */
static inline void KERNEL(anchor_add)(const double *sum, double *restrict total, double *restrict rest)
{
	for (size_t i = 0; i < (size_t)3 * ANCHOR_R * ANCHOR_T; i++) {
		const double before = total[i], after = before + sum[i], added = after - before;
		rest[i] += (before - (after - added)) + (sum[i] - added);
		total[i] = after;
	}
}

static bool KERNEL(robust_anchor)(const struct robust_sample *sample, const struct robust_line *line,
                                  const struct anchor_reach *reach, struct anchor_list *near_list, struct anchor_list *edge_list,
                                  struct anchor_sums *out)
{
	struct KERNEL(anchor_block) b;
	double l4[ANCHOR_BLOCK];
	const lanes4 c = LANES_ALL(line->centre_y), xo = LANES_ALL(line->centre_x), s = LANES_ALL(line->slope), one = LANES_ALL(1);
	const lanes4 reach_y = LANES_ALL(reach->centre_y), reach_slope = LANES_ALL(reach->slope);
	const lanes4 low = LANES_ALL(reach->median_low), high = LANES_ALL(reach->median_high);
	const lanes4 inner = LANES_ALL(reach->limit_low), outer = LANES_ALL(reach->limit_high);
	const mask4 sign = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
	double sum[3][ANCHOR_R][ANCHOR_T], total[3][ANCHOR_R][ANCHOR_T] = {{{0}}}, rest[3][ANCHOR_R][ANCHOR_T] = {{{0}}};
	mask4 below = {0, 0, 0, 0}, outside = {0, 0, 0, 0};

	near_list->count = edge_list->count = 0;
	for (size_t start = 0; start < sample->n; start += ANCHOR_BLOCK) {
		const size_t m = sample->n - start < ANCHOR_BLOCK ? sample->n - start : ANCHOR_BLOCK;
		const double *x = sample->x + start, *y = sample->y + start;
		const double *excess = sample->excess + start;
		double padded[2][ANCHOR_BLOCK];
		double padded_excess[ANCHOR_BLOCK];

		if (near_list->count + ANCHOR_BLOCK > near_list->capacity || edge_list->count + ANCHOR_BLOCK > edge_list->capacity)
			return false;
		if (m < ANCHOR_BLOCK) { /* the last block: filled up with copies, which count for nothing below */
			for (size_t i = 0; i < ANCHOR_BLOCK; i++) {
				const size_t from = i < m ? i : m - 1;
				padded[0][i] = x[from];
				padded[1][i] = y[from];
				padded_excess[i] = excess[from];
			}
			x = padded[0];
			y = padded[1];
			excess = padded_excess;
		}
		for (size_t group = 0; group < ANCHOR_BLOCK; group += ANCHOR_GROUP) {
			int64_t near[ANCHOR_GROUP], edge[ANCHOR_GROUP];
			mask4 listed = {0, 0, 0, 0};
			for (size_t g = 0; g < ANCHOR_GROUP; g += 4) {
				const size_t i = group + g;
				const lanes4 t = LANES_LOAD(x + i) - xo, r = (LANES_LOAD(y + i) - c) - s * t;
				const lanes4 l = one + LANES_LOAD(excess + i);
				const lanes4 v = (lanes4)((mask4)r & sign) * l;
				const lanes4 q = (reach_y + reach_slope * (lanes4)((mask4)t & sign)) * l;
				const lanes4 most = v + q, least = v - q;
				mask4 in = (mask4)(most < inner), out_of = (mask4)(least > outer);
				mask4 under = (mask4)(most < low), near4 = ~(under | (mask4)(least > high)), edge4 = ~(in | out_of);
				if (m < ANCHOR_BLOCK) {
					const mask4 present = {i < m ? -1 : 0, i + 1 < m ? -1 : 0, i + 2 < m ? -1 : 0, i + 3 < m ? -1 : 0};
					in &= present;
					out_of &= present;
					under &= present;
					near4 &= present;
					edge4 &= present;
				}
				const lanes4 kept = (lanes4)(in & (mask4)one), l2 = kept * (l * l);

				LANES_STORE(b.t + i, t);
				LANES_STORE(b.r + i, r);
				LANES_STORE(b.kept + i, kept);
				LANES_STORE(b.l2 + i, l2);
				LANES_STORE(l4 + i, l2 * l2);
				memcpy(near + g, &near4, sizeof near4);
				memcpy(edge + g, &edge4, sizeof edge4);
				listed |= near4 | edge4;
				below += under; /* true is -1 */
				outside += out_of;
			}
			if (listed[0] | listed[1] | listed[2] | listed[3]) {
				KERNEL(anchor_copy)(near_list, x + group, y + group, excess + group, near);
				KERNEL(anchor_copy)(edge_list, x + group, y + group, excess + group, edge);
			}
		}
		memset(sum, 0, sizeof sum);
		KERNEL(anchor_sweep)(&b, b.kept, 0, 3, 2, 1, sum[0]);
		KERNEL(anchor_sweep)(&b, b.l2, 0, 4, 4, 0, sum[1]);
		KERNEL(anchor_sweep)(&b, b.l2, 2, 3, 2, 1, sum[1]);
		KERNEL(anchor_sweep)(&b, l4, 0, 6, 6, 0, sum[2]);
		KERNEL(anchor_sweep)(&b, l4, 2, 5, 4, 0, sum[2]);
		KERNEL(anchor_sweep)(&b, l4, 4, 3, 2, 1, sum[2]);
		KERNEL(anchor_add)((const double *)sum, (double *)total, (double *)rest);
	}
	for (int k = 0; k < 3; k++)
		for (int p = 0; p < ANCHOR_R; p++)
			for (int i = 0; i < ANCHOR_T; i++)
				out->moment[k][p][i] = total[k][p][i] + rest[k][p][i];
	out->below = (size_t) - (below[0] + below[1] + below[2] + below[3]);
	out->outside = (size_t) - (outside[0] + outside[1] + outside[2] + outside[3]);
	return true;
}
