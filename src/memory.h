/*
 * memory.h: large blocks of memory.
 */
#ifndef MEMORY_H
#define MEMORY_H

#include <stddef.h>

/*
 * Asks for huge pages where a block that has not been written yet holds some: filling a table then takes 20 page faults instead
 * of 9,000, and walking through it fewer misses. A hint: failure changes nothing but speed.
 */
void memory_prefer_huge(void *block, size_t bytes);

/* malloc for tables: aligned to a cache line, or, from half a huge page on, to huge pages, which are asked for. For free(). */
void *memory_alloc(size_t bytes);

/*
 * The same for a table that is kept as long as its material: beyond the first, huge pages only where it fills them. One that is
 * filled in part lies in memory as a whole: 4 MB for the compact form's 2.6, 10 for the expanded form's 8.8.
 */
void *memory_alloc_kept(size_t bytes);

#endif
