/* robust_sums.inc.h: the two passes of one iteration of robust.h. See robust_kernels.h. */

enum { ROBUST_BLOCK = 512, ROBUST_GROUP = 16 };

/*
 * Either pass is compiled twice: with the line's rest, which few samples need, and without. The argument `rested` is known at
 * each of its calls.
 */
static ALWAYS_INLINE size_t KERNEL(scale_pass)(const struct robust_sample *sample, const struct robust_line *line, double low,
                                               double high, double *inside, size_t *below, bool rested)
{
	const double *x = sample->x, *y = sample->y;
	const double *excess = sample->excess;
	const lanes4 c = LANES_ALL(line->centre_y), xo = LANES_ALL(line->centre_x), b = LANES_ALL(line->slope);
	const lanes4 lo = LANES_ALL(low), hi = LANES_ALL(high), rest = LANES_ALL(line->rest_y);
	const mask4 sign = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
	mask4 less = {0, 0, 0, 0};
	size_t count = 0, n4 = sample->n / ROBUST_GROUP * ROBUST_GROUP;

	for (size_t i = 0; i < n4; i += ROBUST_GROUP) {
		lanes4 r[ROBUST_GROUP / 4];
		mask4 any = {0, 0, 0, 0};
		for (int g = 0; g < ROBUST_GROUP / 4; g++) {
			const size_t at = i + 4 * (size_t)g;
			lanes4 f = LANES_LOAD(excess + at);
			lanes4 dy = LANES_LOAD(y + at) - c;
			if (rested)
				dy -= rest;
			lanes4 v = dy - b * (LANES_LOAD(x + at) - xo);
			v = v + v * f;
			v = (lanes4)((mask4)v & sign);
			r[g] = v;
			less += (mask4)(v < lo); /* true is -1 */
			any |= (mask4)(v >= lo) & (mask4)(v <= hi);
		}
		if (any[0] | any[1] | any[2] | any[3])
			for (int g = 0; g < ROBUST_GROUP / 4; g++)
				for (int l = 0; l < 4; l++) {
					inside[count] = r[g][l];
					count += r[g][l] >= low && r[g][l] <= high;
				}
	}
	*below = (size_t) - (less[0] + less[1] + less[2] + less[3]);
	for (size_t i = n4; i < sample->n; i++) {
		double dy = y[i] - line->centre_y;
		if (rested)
			dy -= line->rest_y;
		double v = dy - line->slope * (x[i] - line->centre_x);
		v = v + v * excess[i];
		v = v < 0 ? -v : v;
		*below += v < low;
		inside[count] = v;
		count += v >= low && v <= high;
	}
	return count;
}

static size_t KERNEL(robust_scale)(const struct robust_sample *sample, const struct robust_line *line, double low, double high,
                                   double *inside, size_t *below)
{
	return line->rest_y != 0 ? KERNEL(scale_pass)(sample, line, low, high, inside, below, true)
	                         : KERNEL(scale_pass)(sample, line, low, high, inside, below, false);
}

/* Adds x to a sum whose rounding errors gather in *rest (Neumaier). */
static inline void KERNEL(add)(double *sum, double *rest, double x)
{
	double t = *sum + x;
	*rest += (*sum < 0 ? -*sum : *sum) >= (x < 0 ? -x : x) ? (*sum - t) + x : (x - t) + *sum;
	*sum = t;
}

static ALWAYS_INLINE void KERNEL(sums_pass)(const struct robust_sample *sample, const struct robust_line *line,
                                            double inverse_scale, struct robust_sums *out, bool rested)
{
	const lanes4 c = LANES_ALL(line->centre_y), xo = LANES_ALL(line->centre_x), b = LANES_ALL(line->slope);
	const lanes4 scale = LANES_ALL(inverse_scale), one = LANES_ALL(1), zero = LANES_ALL(0), rest_y = LANES_ALL(line->rest_y);
	double sum[6] = {0}, rest[6] = {0};
	mask4 rejected = {0, 0, 0, 0};

	for (size_t start = 0; start < sample->n; start += ROBUST_BLOCK) {
		size_t m = sample->n - start < ROBUST_BLOCK ? sample->n - start : ROBUST_BLOCK;
		const double *x = sample->x + start, *y = sample->y + start;
		const double *excess = sample->excess + start;
		lanes4 s0 = zero, s1 = zero, s2 = zero, s3 = zero, s4 = zero, s5 = zero;
		size_t i = 0;

		for (; i + 4 <= m; i += 4) {
			lanes4 dx = LANES_LOAD(x + i) - xo, dy = LANES_LOAD(y + i) - c;
			if (rested)
				dy -= rest_y;
			lanes4 r = dy - b * dx, f = LANES_LOAD(excess + i);
			lanes4 u = (r + r * f) * scale, q = one - u * u;
			mask4 kept = (mask4)(q > zero);
			rejected += (mask4)(q <= zero); /* true is -1 */
			q = (lanes4)((mask4)q & kept);
			lanes4 w = q * q, wx = w * dx;
			s0 += q;
			s1 += w;
			s2 += wx;
			s3 += wx * dx;
			s4 += w * r;
			s5 += wx * r;
		}
		for (int l = 0; i < m; i++, l++) { /* the last few, one lane each */
			double dx = x[i] - line->centre_x, dy = y[i] - line->centre_y;
			if (rested)
				dy -= line->rest_y;
			double r = dy - line->slope * dx;
			double u = (r + r * excess[i]) * inverse_scale, q = 1 - u * u;
			rejected[l] -= q <= 0;
			q = q > 0 ? q : 0;
			double w = q * q, wx = w * dx;
			s0[l] += q;
			s1[l] += w;
			s2[l] += wx;
			s3[l] += wx * dx;
			s4[l] += w * r;
			s5[l] += wx * r;
		}
		KERNEL(add)(&sum[0], &rest[0], lanes_sum(&s0));
		KERNEL(add)(&sum[1], &rest[1], lanes_sum(&s1));
		KERNEL(add)(&sum[2], &rest[2], lanes_sum(&s2));
		KERNEL(add)(&sum[3], &rest[3], lanes_sum(&s3));
		KERNEL(add)(&sum[4], &rest[4], lanes_sum(&s4));
		KERNEL(add)(&sum[5], &rest[5], lanes_sum(&s5));
	}
	out->root = sum[0] + rest[0];
	out->w = sum[1] + rest[1];
	out->wx = sum[2] + rest[2];
	out->wxx = sum[3] + rest[3];
	out->wr = sum[4] + rest[4];
	out->wxr = sum[5] + rest[5];
	out->rejected = (size_t) - (rejected[0] + rejected[1] + rejected[2] + rejected[3]);
}

static void KERNEL(robust_sums)(const struct robust_sample *sample, const struct robust_line *line, double inverse_scale,
                                struct robust_sums *out)
{
	if (line->rest_y != 0)
		KERNEL(sums_pass)(sample, line, inverse_scale, out, true);
	else
		KERNEL(sums_pass)(sample, line, inverse_scale, out, false);
}
