/* A block that is kept lies in memory with its own bytes only, whatever pages it is made of; lists grow by doubling. */
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
		cmocka_unit_test(a_list_grows_by_doubling_and_keeps_what_it_holds),
		cmocka_unit_test(a_block_is_kept_as_long_as_it_holds_what_is_asked_for),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
