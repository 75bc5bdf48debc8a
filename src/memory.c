#include "memory.h"

#include <stdint.h>
#include <sys/mman.h>

void memory_prefer_huge(void *block, size_t bytes)
{
#ifdef MADV_HUGEPAGE
	const size_t huge = (size_t)2 << 20;
	const uintptr_t start = ((uintptr_t)block + huge - 1) / huge * huge, end = ((uintptr_t)block + bytes) / huge * huge;
	if (end > start)
		madvise((void *)start, end - start, MADV_HUGEPAGE);
#else
	(void)block, (void)bytes;
#endif
}
