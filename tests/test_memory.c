/* A block that is kept lies in memory with its own bytes only, whatever pages it is made of; tables do not split the heap; lists grow by doubling. */
#include <limits.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "memory.h"

static size_t resident_bytes(void)
{
	unsigned long all = 0, resident = 0;
	FILE *file = fopen("/proc/self/statm", "r");
	assert_non_null(file);
	assert_int_equal(fscanf(file, "%lu %lu", &all, &resident), 2);
	fclose(file);
	return resident * (size_t)sysconf(_SC_PAGESIZE);
}

/* The compact form of a material, and a block that ends just in a third page: rounded up they would take half as much again. */
static void a_kept_block_takes_its_own_bytes_and_no_huge_page_more(void **user)
{
	enum { COUNT = 16 };
	const size_t bytes[] = {2590000, 4200000};
	(void)user;
	for (int n = 0; n < 2; n++) {
		void *block[COUNT];
		size_t before = resident_bytes();
		for (int m = 0; m < COUNT; m++) {
			block[m] = memory_alloc_kept(bytes[n]);
			assert_non_null(block[m]);
			assert_int_equal((uintptr_t)block[m] % 64, 0);
			memset(block[m], 1, bytes[n]);
		}
		size_t after = resident_bytes();
		if (after > before + COUNT * (bytes[n] + bytes[n] / 3)) /* a third: sanitizers and valgrind keep a shadow */
			fail_msg("%d blocks of %zu bytes take %zu", COUNT, bytes[n], after - before);
		for (int m = 0; m < COUNT; m++)
			free(block[m]);
	}
}

/*
 * A worker keeps its freed memory for the next material (tool/worker_process.c). Tables of many sizes that come and go between
 * small blocks that stay must find the place of earlier ones.
 */
static void tables_that_come_and_go_do_not_split_the_heap(void **user)
{
#ifdef __GLIBC__
	enum { TABLES = 8, ROUNDS = 50 };
	static const size_t bytes[TABLES] = {35000000, 17500000, 6000000, 2600000, 9000000, 4300000, 1500000, 18000000};
	void *table[TABLES], *small[TABLES], *kept[ROUNDS];
	size_t all = 0;
	(void)user;
	mallopt(M_MMAP_MAX, 0);
	mallopt(M_TRIM_THRESHOLD, INT_MAX);
	for (size_t i = 0; i < ROUNDS; i++) {
		for (size_t k = 0; k < TABLES; k++) {
			table[k] = memory_alloc(bytes[(k + i) % TABLES]);
			small[k] = malloc(1000 + 37 * i);
			assert_non_null(table[k]);
			assert_non_null(small[k]);
		}
		for (size_t k = 0; k < TABLES; k++) {
			free(table[k]);
			free(small[k]);
		}
		kept[i] = malloc(500);
		assert_non_null(kept[i]);
	}
	for (size_t k = 0; k < TABLES; k++)
		all += bytes[k];
	const size_t heap = mallinfo2().arena; /* 0 under sanitizers */
	for (size_t i = 0; i < ROUNDS; i++)
		free(kept[i]);
	if (heap > 5 * all)
		fail_msg("the heap takes %zu bytes for tables of %zu", heap, all);
#else
	(void)user;
	skip();
#endif
}

/* Written beyond its room a list would trip the sanitizers; moved more often than it doubles, this count. */
static void a_list_grows_by_doubling_and_keeps_what_it_holds(void **user)
{
	enum { COUNT = 1000 };
	uint32_t *list = NULL, *last = NULL;
	int moved = 0;
	(void)user;
	for (uint32_t n = 0; n < COUNT; n++) {
		const bool full = n == 0 || (n >= 16 && (n & (n - 1)) == 0);
		last = list;
		list = memory_grown(list, n, sizeof *list);
		assert_non_null(list);
		assert_true(full || list == last);
		moved += full;
		list[n] = n;
	}
	assert_int_equal(moved, 7); /* to 16, 32, ... 1024 */
	for (uint32_t n = 0; n < COUNT; n++)
		assert_int_equal(list[n], n);
	free(list);
}

static void a_block_is_kept_as_long_as_it_holds_what_is_asked_for(void **user)
{
	(void)user;
	size_t room = 0;
	char *block = memory_roomy(NULL, &room, 0), *first;
	assert_non_null(block);
	block = memory_roomy(block, &room, 100);
	assert_non_null(block);
	assert_int_equal(room, 200);
	memset(block, 1, room);
	first = block;
	assert_ptr_equal(memory_roomy(block, &room, 200), first);
	assert_int_equal(room, 200);
	block = memory_roomy(block, &room, 201);
	assert_int_equal(room, 402);
	free(block);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_kept_block_takes_its_own_bytes_and_no_huge_page_more),
		cmocka_unit_test(tables_that_come_and_go_do_not_split_the_heap),
		cmocka_unit_test(a_list_grows_by_doubling_and_keeps_what_it_holds),
		cmocka_unit_test(a_block_is_kept_as_long_as_it_holds_what_is_asked_for),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
