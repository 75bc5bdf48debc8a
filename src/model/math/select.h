/*
 * select.h: order statistics without sorting.
 */
#ifndef MODEL_MATH_SELECT_H
#define MODEL_MATH_SELECT_H

#include <stddef.h>

/*
 * Rearranges v[0..n-1] so that v[k] is the k-th smallest (k = 0 is the least), nothing before it is larger and
 * nothing behind it smaller; returns it. n >= 1, k < n, no NaN. Expected time is proportional to n.
 */
double select_kth(double *v, size_t n, size_t k);

#endif
