/* robust_kernels.h: the passes over the observations of one regression, compiled twice (math/kernels.h). */
#ifndef MODEL_ROBUST_ROBUST_KERNELS_H
#define MODEL_ROBUST_ROBUST_KERNELS_H

#include <stdbool.h>
#include <stddef.h>

#include "model/math/kernels.h"

/* Observations of one regression; see robust.h. excess = 1/sqrt(1 - leverage) - 1. */
struct robust_sample {
	const double *x, *y;
	const double *excess;
	size_t n;
};

/* y = centre_y + rest_y + slope (x - centre_x) */
struct robust_line {
	double centre_x, centre_y, slope;
	double rest_y; /* what rounding took from centre_y; 0 where that is nothing beside the residuals. Anchors know none. */
};

/* Sums over the sample: dx = x - centre_x, r = y - line, w = q^2 the bisquare weight. */
struct robust_sums {
	double root; /* of q = max(0, 1 - u^2) */
	double w, wx, wxx, wr, wxr;
	size_t rejected; /* observations of weight 0 */
};

/* How far the line and the scale may move from an anchor, and the bounds that follow; see robust_anchor.h. */
struct anchor_reach {
	double centre_y, slope;         /* largest changes of the line, its centre_x held */
	double median_low, median_high; /* the median stays between these */
	double limit_low, limit_high;   /* and the residual from which on a weight is 0 between these */
};

/* Copies of some observations: `capacity` places, of which `count` are taken. */
struct anchor_list {
	double *x, *y;
	double *excess;
	size_t count, capacity;
};

enum { ANCHOR_R = 6, ANCHOR_T = 7 };
struct anchor_sums {
	/*
	 * moment[k][p][i] = sum of l^(2k) r^p t^i, l = 1 + excess, r = y - line, t = x - centre_x, over the observations whose
	 * weight stays above 0; for p + i <= 2 + 2k, p <= 1 + 2k or k = 0, else 0.
	 */
	double moment[3][ANCHOR_R][ANCHOR_T];
	size_t below;   /* observations that stay below the median */
	size_t outside; /* observations whose weight stays 0 */
};

struct robust_kernels {
	/*
	 * With v = |y - line| (1 + excess) of every observation: *below = how many are < low; copies those in [low, high] to
	 * inside (n + 1 long) and returns how many they are.
	 */
	size_t (*robust_scale)(const struct robust_sample *sample, const struct robust_line *line, double low, double high,
	                       double *inside, size_t *below);

	/* The weighted sums with u = (y - line) (1 + excess) inverse_scale. Blocks of 512 in four lanes, blocks compensated. */
	void (*robust_sums)(const struct robust_sample *sample, const struct robust_line *line, double inverse_scale,
	                    struct robust_sums *out);

	/*
	 * All of *out for one line, and the lists; blocks of 256 in four lanes, blocks compensated. False, with these unspecified,
	 * when a list has no room for another 256.
	 */
	bool (*robust_anchor)(const struct robust_sample *sample, const struct robust_line *line, const struct anchor_reach *reach,
	                      struct anchor_list *near, struct anchor_list *edge, struct anchor_sums *out);
};

KERNELS_OF(robust)

#endif
