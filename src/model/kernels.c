/* kernels.c: the loops for any processor, and the choice between the two tables. */
#define KERNEL(name) name##_plain
#include "kernels.inc.h"

int kernels_avx2_usable(void)
{
#if (defined(__x86_64__) || defined(__i386__)) && !defined(BRDFPACK_PLAIN_KERNELS) /* for tests: as without AVX2 */
	return __builtin_cpu_supports("avx2") != 0;
#else
	return 0;
#endif
}

const struct kernels *kernels_get(void)
{
	/* Racing threads store the same pointer. */
	static const struct kernels *chosen;
	const struct kernels *table = __atomic_load_n(&chosen, __ATOMIC_RELAXED);

	if (!table) {
		table = kernels_avx2_usable() ? &kernels_avx2 : &kernels_plain;
		__atomic_store_n(&chosen, table, __ATOMIC_RELAXED);
	}
	return table;
}
