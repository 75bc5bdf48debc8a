/* fidelity_kernels.inc.h: the loops of fidelity_kernels.h, for the including file's target. KERNEL(name) must be defined. */
#include <stdbool.h>

#include "fidelity_kernels.h"
#include "memory.h"
#include "model/math/fast_math.h"
#include "model/math/vector.h"

enum { FIDELITY_BLOCK = 64 };

/* One block of the measured table: what all decoded ones are compared with. A cell that does not count has b = keep = 0. */
struct KERNEL(fidelity_block) {
	double b[FIDELITY_BLOCK], keep[FIDELITY_BLOCK], cosine[FIDELITY_BLOCK];
	double shifted[FIDELITY_BLOCK]; /* b + 1e-3 */
	double offset[FIDELITY_BLOCK];  /* b + 1e-2 */
	double near[FIDELITY_BLOCK];    /* b/16; 0 where 1/b might be infinite */
	double root[FIDELITY_BLOCK];    /* cbrt(b cosine) */
	double inverse[FIDELITY_BLOCK]; /* 1/b, where near is 0 any; set when first needed */
	double shifted_inverse[FIDELITY_BLOCK];
	double hidden[FIDELITY_BLOCK]; /* 1 where a cell cannot be seen, else 0; only set where any_hidden */
	bool has_inverse, has_shifted_inverse, any_hidden;
};

struct KERNEL(fidelity_squares) {
	lanes4 logs, cubes, hidden;
};

/* Few blocks hold a hidden cell. */
static inline void KERNEL(fidelity_hide)(const uint8_t *hidden, size_t m, struct KERNEL(fidelity_block) *t)
{
	unsigned any = 0;

	for (size_t l = 0; l < m; l++)
		any |= hidden[l];
	t->any_hidden = any != 0;
	for (size_t l = 0; any && l < FIDELITY_BLOCK; l++)
		t->hidden[l] = l < m && hidden[l] ? 1 : 0;
}

/* The first m cells of a block from the tables, the others made not to count. */
static inline void KERNEL(fidelity_prepare)(const double *b, const uint8_t *valid, const float *cosine, size_t m,
                                            struct KERNEL(fidelity_block) *t)
{
	double padded_b[FIDELITY_BLOCK];
	uint8_t padded_valid[FIDELITY_BLOCK];
	float padded_cosine[FIDELITY_BLOCK];

	if (m < FIDELITY_BLOCK) {
		for (size_t l = 0; l < FIDELITY_BLOCK; l++) {
			padded_b[l] = l < m ? b[l] : 0;
			padded_valid[l] = l < m ? valid[l] : 0;
			padded_cosine[l] = l < m ? cosine[l] : 0;
		}
		b = padded_b;
		valid = padded_valid;
		cosine = padded_cosine;
	}
	for (size_t l = 0; l < FIDELITY_BLOCK; l++)
		t->keep[l] = valid[l] ? 1 : 0;
	for (size_t l = 0; l < FIDELITY_BLOCK; l++) {
		t->b[l] = b[l] * t->keep[l];
		t->cosine[l] = (double)cosine[l];
		t->shifted[l] = t->b[l] + 1e-3;
		t->offset[l] = t->b[l] + 1e-2;
		t->near[l] = t->b[l] > 1e-290 ? t->b[l] * (1.0 / 16) : 0;
	}
	for (size_t l = 0; l < FIDELITY_BLOCK; l++)
		t->root[l] = fast_cbrt(t->b[l] * t->cosine[l]);
	t->has_inverse = t->has_shifted_inverse = false;
}

/*
 * Where d = e - b is small in a whole block, |d| <= b/16, as it is nearly everywhere in a good record, with less work and
 * without loss however small it is:
 *
 *     log2((e + 1e-3)/(b + 1e-3)) = (2/ln 2) atanh s, s = d/(2 b + 2e-3 + d), |s| <= 1/31
 *     cbrt(e) - cbrt(b) = cbrt(b) ((1 + r)^(1/3) - 1), r = d/b
 *
 * Both are polynomials of least relative error on these ranges: 1e-15, 2e-15.
 */
static ALWAYS_INLINE void KERNEL(fidelity_close)(struct KERNEL(fidelity_block) *t, const double *difference, bool any_hidden,
                                                 struct KERNEL(fidelity_squares) *to)
{
	lanes4 logs = {0, 0, 0, 0}, cubes = {0, 0, 0, 0}, hidden = {0, 0, 0, 0};

	if (!t->has_inverse)
		for (size_t l = 0; l < FIDELITY_BLOCK; l++)
			t->inverse[l] = 1 / (t->near[l] > 0 ? t->b[l] : 1);
	t->has_inverse = true;
	for (size_t l = 0; l < FIDELITY_BLOCK; l += WIDE) {
		const lanes_wide d = WIDE_LOAD(difference + l), shifted = WIDE_LOAD(t->shifted + l);
		const lanes_wide s = d / (shifted + shifted + d), z = s * s;
		lanes_wide p = z * WIDE_ALL(0.41286660545526166) + WIDE_ALL(0.57707758172130574);
		p = p * z + WIDE_ALL(0.96179669401644918);
		p = p * z + WIDE_ALL(2.8853900817779237);
		p *= s;
		p *= p;
		WIDE_ADD_TO(logs, p);
		if (any_hidden) {
			const lanes_wide unseen = p * WIDE_LOAD(t->hidden + l);
			WIDE_ADD_TO(hidden, unseen);
		}

		/* Even and odd powers apart: half as long a chain. */
		const lanes_wide r = d * WIDE_LOAD(t->inverse + l), q = r * r;
		lanes_wide even = q * WIDE_ALL(0.013591770827014168) + WIDE_ALL(0.019000804152989052);
		lanes_wide odd = q * WIDE_ALL(-0.015937536993844745) - WIDE_ALL(0.023471728782429886);
		even = even * q + WIDE_ALL(0.03017832700333542);
		odd = odd * q - WIDE_ALL(0.041152263703458002);
		even = even * q + WIDE_ALL(0.06172839506145647);
		odd = odd * q - WIDE_ALL(0.11111111111101468);
		even = even * q + WIDE_ALL(0.33333333333333337);
		const lanes_wide cube = (even + odd * r) * (r * WIDE_LOAD(t->root + l)), square = cube * cube;
		WIDE_ADD_TO(cubes, square);
	}
	to->logs = logs;
	to->cubes = cubes;
	to->hidden = hidden;
}

static inline void KERNEL(fidelity_far)(struct KERNEL(fidelity_block) *t, const double *e, struct KERNEL(fidelity_squares) *to)
{
	double logs[FIDELITY_BLOCK], cubes[FIDELITY_BLOCK];

	if (!t->has_shifted_inverse)
		for (size_t l = 0; l < FIDELITY_BLOCK; l++)
			t->shifted_inverse[l] = 1 / t->shifted[l];
	t->has_shifted_inverse = true;
	for (size_t l = 0; l < FIDELITY_BLOCK; l++)
		logs[l] = fast_log2((e[l] + 1e-3) * t->shifted_inverse[l]);
	for (size_t l = 0; l < FIDELITY_BLOCK; l++)
		cubes[l] = fast_cbrt(e[l] * t->cosine[l]) - t->root[l];
	*to = (struct KERNEL(fidelity_squares)){{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
	for (size_t l = 0; l < FIDELITY_BLOCK; l += 4) {
		const lanes4 x = LANES_LOAD(logs + l), y = LANES_LOAD(cubes + l);
		to->logs += x * x;
		to->cubes += y * y;
	}
	for (size_t l = 0; t->any_hidden && l < FIDELITY_BLOCK; l += 4) {
		const lanes4 x = LANES_LOAD(logs + l);
		to->hidden += x * x * LANES_LOAD(t->hidden + l);
	}
}

/* The largest |d|/(b + 1e-2), or `largest` if that is larger. */
static inline double KERNEL(fidelity_largest)(const struct KERNEL(fidelity_block) *t, const double *d, double largest)
{
	uint64_t larger = 0;

	for (size_t l = 0; l < FIDELITY_BLOCK; l++)
		larger |= __builtin_fabs(d[l]) > largest * t->offset[l];
	if (larger) /* seldom: the division is worth a branch */
		for (size_t l = 0; l < FIDELITY_BLOCK; l++) {
			const double relative = __builtin_fabs(d[l]) / t->offset[l];
			largest = relative > largest ? relative : largest;
		}
	return largest;
}

/* Adds the block of one table, of which m cells are there. */
static inline void KERNEL(fidelity_add)(struct KERNEL(fidelity_block) *t, const float *table, size_t m, double unit,
                                        struct fidelity_sums *sums)
{
	double e[FIDELITY_BLOCK], d[FIDELITY_BLOCK];
	float padded[FIDELITY_BLOCK];
	struct KERNEL(fidelity_squares) squares;
	uint64_t far = 0;

	if (m < FIDELITY_BLOCK) {
		for (size_t l = 0; l < FIDELITY_BLOCK; l++)
			padded[l] = l < m ? table[l] : 0;
		table = padded;
	}
	for (size_t l = 0; l < FIDELITY_BLOCK; l++) {
		e[l] = unit * (double)table[l] * t->keep[l];
		d[l] = e[l] - t->b[l];
		far |= __builtin_fabs(d[l]) > t->near[l];
	}
	if (far || sums->largest_relative < 1.0 / 16) /* what is close is not larger */
		sums->largest_relative = KERNEL(fidelity_largest)(t, d, sums->largest_relative);
	if (far)
		KERNEL(fidelity_far)(t, e, &squares);
	else if (t->any_hidden)
		KERNEL(fidelity_close)(t, d, true, &squares);
	else
		KERNEL(fidelity_close)(t, d, false, &squares);
	sums->log_squares += lanes_sum(&squares.logs);
	if (t->any_hidden)
		sums->hidden_log_squares += lanes_sum(&squares.hidden);
	sums->cube_root_squares += lanes_sum(&squares.cubes);
}

static void KERNEL(fidelity_slice)(const double *b, const uint8_t *valid, const uint8_t *hidden, const float *cosine, size_t n,
                                   const struct fidelity_table *tables, size_t count)
{
	struct KERNEL(fidelity_block) block;

	for (size_t start = 0; start < n; start += FIDELITY_BLOCK) {
		const size_t m = n - start < FIDELITY_BLOCK ? n - start : FIDELITY_BLOCK;
		unsigned any = 0;

		for (size_t l = 0; l < m; l++)
			any |= valid[start + l];
		if (!any)
			continue;
		KERNEL(fidelity_prepare)(b + start, valid + start, cosine + start, m, &block);
		KERNEL(fidelity_hide)(hidden + start, m, &block);
		/* Four blocks on: more streams at once than a processor foresees. */
		for (size_t l = 0; l < FIDELITY_BLOCK; l += 16) {
			memory_ask(b + start, (4 * FIDELITY_BLOCK + l) * sizeof *b);
			memory_ask(b + start, (4 * FIDELITY_BLOCK + l + 8) * sizeof *b);
			for (size_t k = 0; k < count; k++)
				memory_ask(tables[k].e + start, (4 * FIDELITY_BLOCK + l) * sizeof *tables[k].e);
		}
		for (size_t k = 0; k < count; k++)
			KERNEL(fidelity_add)(&block, tables[k].e + start, m, tables[k].unit, tables[k].sums);
	}
}

const struct fidelity_kernels KERNEL(fidelity_kernels) = {
	.fidelity_slice = KERNEL(fidelity_slice),
};
