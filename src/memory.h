/*
 * memory.h: large blocks of memory, and lists that grow.
 */
#ifndef MEMORY_H
#define MEMORY_H

#include <stddef.h>
#include <stdint.h>

#include "brdfpack.h"

/*
 * Asks for huge pages where a block that has not been written yet holds some: filling a table then takes 20 page faults instead
 * of 9,000, and walking through it fewer misses. A hint: failure changes nothing but speed.
 */
void memory_prefer_huge(void *block, size_t bytes);

/* Asks for what lies `bytes` bytes after p, or before it: an address, since nothing need be there. */
#define memory_ask(p, bytes) __builtin_prefetch((const void *)((uintptr_t)(p) + (uintptr_t)(ptrdiff_t)(bytes)))

/*
 * malloc for tables that are soon freed: aligned to a cache line, huge pages asked for where it holds some. For free(). Not
 * aligned to these: what malloc cuts off before and behind such a block splits the memory that a worker keeps, which then grew
 * from 150 to 370 MB in one of five builds.
 */
void *memory_alloc(size_t bytes);

/*
 * What is kept as long as its material. From half a huge page on it asks for huge pages, but beyond the first only where a block
 * fills them: one that is filled in part lies in memory as a whole, 4 MB for the compact form's 2.6, 10 for the expanded form's
 * 8.8.
 *
 * It comes from the allocator that the calling thread has set, and goes back to it: malloc where none is. The public functions
 * that make or free a material set the material's own.
 */
void *memory_alloc_kept(size_t bytes);
void memory_free_kept(void *block); /* NULL is allowed */

/* Sets the thread's allocator of kept memory, NULL for malloc, and returns the one before; *allocator stays the caller's. */
const bp_allocator *memory_allocator_set(const bp_allocator *allocator);

/*
 * A list with room for one more behind `count` elements of `size` bytes: the same, or realloc'ed. NULL: no memory; the list is as
 * it was. Lists that grow by this alone have room for a power of two, so nobody keeps it.
 */
void *memory_grown(void *list, size_t count, size_t size);

/*
 * A block of at least `bytes` bytes, whatever stands in it: the same, or a new one of twice as many. NULL: no memory, and the old
 * one is freed.
 */
void *memory_roomy(void *block, size_t *room, size_t bytes);

#endif
