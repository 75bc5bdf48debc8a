#include "kernels.h"

#if (defined(__x86_64__) || defined(__i386__)) && !defined(BRDFPACK_PLAIN_KERNELS) /* for tests: as without AVX2 */
#define HAS(feature) (__builtin_cpu_supports(feature) != 0)
#else
#define HAS(feature) 0
#endif

int kernels_avx2_usable(void) { return HAS("avx2"); }

int kernels_avx512_usable(void) { return HAS("avx512f") && HAS("avx512bw") && HAS("avx512dq") && HAS("avx512vl"); }
