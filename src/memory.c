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

static void *alloc_aligned(size_t bytes)
{
	void *block = NULL;
	if (posix_memalign(&block, bytes < HUGE_PAGE / 2 ? CACHE_LINE : HUGE_PAGE, bytes) != 0)
		return NULL;
	memory_prefer_huge(block, bytes);
	return block;
}

static size_t huge_pages_round_up(size_t bytes)
{
	return (bytes + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
}

void *memory_alloc(size_t bytes)
{
	return alloc_aligned(bytes < HUGE_PAGE / 2 ? bytes : huge_pages_round_up(bytes));
}

void *memory_alloc_kept(size_t bytes)
{
	return bytes < HUGE_PAGE ? memory_alloc(bytes) : alloc_aligned(bytes);
}
