#include "memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

enum { CACHE_LINE = 64, HUGE_PAGE = 1 << 21 };

void memory_prefer_huge(void *block, size_t bytes)
{
#ifdef MADV_HUGEPAGE
	const size_t huge = HUGE_PAGE;
	const uintptr_t start = ((uintptr_t)block + huge - 1) / huge * huge, end = ((uintptr_t)block + bytes) / huge * huge;
	if (end > start)
		madvise((void *)start, end - start, MADV_HUGEPAGE);
#else
	(void)block, (void)bytes;
#endif
}

void *memory_alloc(size_t bytes)
{
	const size_t alignment = bytes < HUGE_PAGE / 2 ? CACHE_LINE : HUGE_PAGE;
	void *block = aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
	if (block)
		memory_prefer_huge(block, (bytes + alignment - 1) / alignment * alignment);
	return block;
}
