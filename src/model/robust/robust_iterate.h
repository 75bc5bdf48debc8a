/*
 * robust_iterate.h: the iterations of robust.h on a prepared sample. Internal to it.
 */
#ifndef MODEL_ROBUST_ROBUST_ITERATE_H
#define MODEL_ROBUST_ROBUST_ITERATE_H

#include "robust.h"
#include "robust_anchor.h"

/* The observations, and what the unweighted design gives once. */
struct design {
	double *x;      /* n values, scaled by 2^-x_exponent */
	double *y;      /* n values, scaled so that the largest is about 1 */
	double *excess; /* 1/sqrt(1 - h) - 1 */
	double *inside; /* n + 1: values gathered around the median */
	double *picked; /* room for x and y of robust_picks(n) observations */
	double *picked_excess;
	size_t n;
	int x_exponent;
	double mean_x, sxx;
	struct robust_anchor anchor; /* room for one, or empty where n is small */
};

/* The regression of y on x of a prepared design: coefficients in the scaled units. n >= 2. At most `limit` iterations. */
void robust_iterate(struct design *design, uint32_t limit, struct robust_fit *out);

#endif
