/*
 * clones.h: how a function is compiled: inlined whatever its size, or for AVX2 besides, one of both being chosen by the loader.
 *
 * AVX2_CLONE is for loops that the compiler turns into vectors, and that no table of model/math/kernels.h holds. Both give the
 * same bits: as everywhere, no multiplication and addition are fused, and no sum of floats is reordered. What such a function
 * calls has to be inlined into it, or is compiled once. It is static, since the loader sees others whatever their visibility.
 * Only where the loader is known to do it: gcc and glibc on x86-64; not in a sanitizer's build, whose memory is not ready when
 * the loader asks.
 */
#ifndef CLONES_H
#define CLONES_H

#include <stdint.h> /* for __GLIBC__ */

#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
	!defined(__SANITIZE_THREAD__) && !defined(BRDFPACK_PLAIN_KERNELS) && !defined(BP_PORTABLE)
#define AVX2_CLONE __attribute__((target_clones("avx2", "default")))
#else
#define AVX2_CLONE
#endif
#define ALWAYS_INLINE inline __attribute__((always_inline))

#endif
