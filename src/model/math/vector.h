/*
 * vector.h: lanes for sums in a fixed order. Only for the .inc.h files of kernels.h.
 *
 * A lanes4 is four doubles that add independently, whatever the processor's vectors are; lanes_sum joins
 * them in one order. gcc and clang split the type into what the target has. Vectors are passed by pointer:
 * by value their calling convention depends on the target.
 */
#ifndef MODEL_MATH_VECTOR_H
#define MODEL_MATH_VECTOR_H

#include <stdint.h>

#include "clones.h"

typedef double lanes4 __attribute__((vector_size(32)));
typedef int64_t mask4 __attribute__((vector_size(32)));
typedef double lanes4_unaligned __attribute__((vector_size(32), aligned(8), may_alias));

typedef float floats4 __attribute__((vector_size(16)));
typedef float floats4_unaligned __attribute__((vector_size(16), aligned(4), may_alias));

typedef float floats8 __attribute__((vector_size(32)));
typedef float floats8_unaligned __attribute__((vector_size(32), aligned(4), may_alias));

/* Four doubles at p, which need not be aligned. */
#define LANES_LOAD(p) ((lanes4)(*(const lanes4_unaligned *)(p)))
#define LANES_STORE(p, v) (*(lanes4_unaligned *)(p) = (v))
#define FLOATS_LOAD(p) ((floats4)(*(const floats4_unaligned *)(p)))
#define FLOATS8_LOAD(p) ((floats8)(*(const floats8_unaligned *)(p)))
#define FLOATS8_STORE(p, v) (*(floats8_unaligned *)(p) = (v))
#define LANES_ALL(x) ((lanes4){(x), (x), (x), (x)})

/* As many as the target's vectors take, where these hold eight doubles. Sums of doubles are of four lanes all the same. */
#ifdef __AVX512F__
typedef float floats_wide __attribute__((vector_size(64)));
typedef float floats_wide_unaligned __attribute__((vector_size(64), aligned(4), may_alias));
typedef double lanes_wide __attribute__((vector_size(64)));
typedef double lanes_wide_unaligned __attribute__((vector_size(64), aligned(8), may_alias));
#define WIDE_ALL(x) ((lanes_wide){(x), (x), (x), (x), (x), (x), (x), (x)})
#define WIDE_ADD_TO(sum, v) \
	((sum) += __builtin_shufflevector((v), (v), 0, 1, 2, 3), (sum) += __builtin_shufflevector((v), (v), 4, 5, 6, 7))
#else
typedef floats8 floats_wide;
typedef floats8_unaligned floats_wide_unaligned;
typedef lanes4 lanes_wide;
typedef lanes4_unaligned lanes_wide_unaligned;
#define WIDE_ALL(x) LANES_ALL(x)
#define WIDE_ADD_TO(sum, v) ((sum) += (v))
#endif
enum { WIDE = sizeof(lanes_wide) / sizeof(double), FLOATS_WIDE = sizeof(floats_wide) / sizeof(float) };
#define FLOATS_WIDE_LOAD(p) ((floats_wide)(*(const floats_wide_unaligned *)(p)))
#define FLOATS_WIDE_STORE(p, v) (*(floats_wide_unaligned *)(p) = (v))
#define WIDE_LOAD(p) ((lanes_wide)(*(const lanes_wide_unaligned *)(p)))

static inline double lanes_sum(const lanes4 *v) { return ((*v)[0] + (*v)[1]) + ((*v)[2] + (*v)[3]); }

#endif
