#include "kernels.h"

int kernels_avx2_usable(void)
{
#if (defined(__x86_64__) || defined(__i386__)) && !defined(BRDFPACK_PLAIN_KERNELS) /* for tests: as without AVX2 */
	return __builtin_cpu_supports("avx2") != 0;
#else
	return 0;
#endif
}
