#include "memory.h"

#include <stdint.h>
#include <stdlib.h>

#include "system.h"

enum { CACHE_LINE = 64, HUGE_PAGE = 1 << 21 };

static _Thread_local const bp_allocator *allocator_now;

void memory_prefer_huge(void *block, size_t bytes)
{
	const size_t huge = HUGE_PAGE;
	const uintptr_t start = ((uintptr_t)block + huge - 1) / huge * huge, end = ((uintptr_t)block + bytes) / huge * huge;
	if (end > start)
		system_prefer_huge((void *)start, end - start);
}

static size_t alignment_for(size_t bytes) { return bytes < HUGE_PAGE / 2 ? CACHE_LINE : HUGE_PAGE; }

static void *alloc_aligned(size_t bytes, size_t alignment)
{
	void *block = system_alloc(bytes, alignment);
	if (block)
		memory_prefer_huge(block, bytes);
	return block;
}

void *memory_alloc(size_t bytes) { return alloc_aligned(bytes, CACHE_LINE); }

void *memory_alloc_kept(size_t bytes)
{
	const size_t alignment = alignment_for(bytes);
	if (allocator_now)
		return allocator_now->alloc(allocator_now->user, bytes, alignment);
	return bytes < HUGE_PAGE ? memory_alloc(bytes) : alloc_aligned(bytes, alignment);
}

void memory_free_kept(void *block)
{
	if (!allocator_now)
		free(block);
	else if (block)
		allocator_now->release(allocator_now->user, block);
}

const bp_allocator *memory_allocator_set(const bp_allocator *allocator)
{
	const bp_allocator *before = allocator_now;
	allocator_now = allocator;
	return before;
}

void *memory_grown(void *list, size_t count, size_t size)
{
	if (count & (count - 1) || (count && count < 16))
		return list;
	return realloc(list, (count ? 2 * count : 16) * size);
}

void *memory_roomy(void *block, size_t *room, size_t bytes)
{
	if (block && bytes <= *room)
		return block;
	free(block);
	*room = 2 * bytes;
	return malloc(*room ? *room : 1);
}
