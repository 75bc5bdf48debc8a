/* How many workers: what control groups of both versions say, nested or not, and what memory allows. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "scratch.h"
#include "tool/cores.h"
#include "tool/workers.h"

static char root[SCRATCH_BYTES];

static void put(const char *path, const char *text)
{
	char whole[512];
	snprintf(whole, sizeof whole, "%s/%s", root, path);
	for (char *slash = whole + strlen(root) + 1; (slash = strchr(slash, '/')); *slash++ = '/') {
		*slash = '\0';
		mkdir(whole, 0755);
	}
	FILE *file = fopen(whole, "w");
	assert_non_null(file);
	fputs(text, file);
	fclose(file);
}

static struct cores_limits read_limits(void) { return cores_limits_read(root, scratch_in(root, "groups")); }

static int setup(void **state)
{
	(void)state;
	return scratch_folder(root);
}

static int teardown(void **state)
{
	(void)state;
	return scratch_remove(root);
}

static void nothing_said_is_no_limit(void **state)
{
	(void)state;
	assert_true(isinf(read_limits().cores) && isinf(read_limits().bytes));
	put("groups", "0::/user.slice/job\n");
	put("user.slice/job/cpu.max", "max 100000\n");
	put("user.slice/job/memory.max", "max\n");
	assert_true(isinf(read_limits().cores) && isinf(read_limits().bytes));
}

static void the_least_of_nested_groups_of_version_2_holds(void **state)
{
	(void)state;
	put("groups", "0::/user.slice/job/step\n");
	put("user.slice/cpu.max", "150000 100000\n");
	put("user.slice/job/cpu.max", "800000 100000\n");
	put("user.slice/job/step/cpu.max", "max 100000\n");
	put("user.slice/job/memory.max", "2000000000\n");
	put("user.slice/job/step/memory.max", "3000000000\n");
	const struct cores_limits limits = read_limits();
	assert_true(limits.cores == 1.5 && limits.bytes == 2e9);
	put("cpu.max", "100000 100000\n"); /* a container's own root */
	assert_true(read_limits().cores == 1);
}

static void version_1_says_it_in_two_files_of_two_trees(void **state)
{
	(void)state;
	put("groups", "5:memory:/docker/a\n4:cpuset:/\n3:cpu,cpuacct:/docker/a\n");
	put("cpu/docker/a/cpu.cfs_quota_us", "250000\n");
	put("cpu/docker/a/cpu.cfs_period_us", "100000\n");
	put("cpu/docker/cpu.cfs_quota_us", "-1\n");
	put("cpu/docker/cpu.cfs_period_us", "100000\n");
	put("memory/docker/a/memory.limit_in_bytes", "9223372036854771712\n");
	put("memory/docker/memory.limit_in_bytes", "1000000000\n");
	const struct cores_limits limits = read_limits();
	assert_true(limits.cores == 2.5 && limits.bytes == 1e9);
}

static void cores_quota_and_memory_bound_the_workers(void **state)
{
	const struct cores_limits none = {INFINITY, INFINITY};
	(void)state;
	assert_int_equal(cores_allowed(8, 64e9, none), 8);
	assert_int_equal(cores_allowed(8, 64e9, (struct cores_limits){2.5, INFINITY}), 3);
	assert_int_equal(cores_allowed(8, 64e9, (struct cores_limits){0.1, INFINITY}), 1);
	assert_int_equal(cores_allowed(64, 64e9, (struct cores_limits){INFINITY, 1.1e9}), 6);
	assert_int_equal(cores_allowed(64, 500e6, none), 2);
	assert_int_equal(cores_allowed(64, 50e6, none), 1);
	assert_int_equal(cores_allowed(1000, 1e12, none), WORKERS_MAX);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(nothing_said_is_no_limit, setup, teardown),
		cmocka_unit_test_setup_teardown(the_least_of_nested_groups_of_version_2_holds, setup, teardown),
		cmocka_unit_test_setup_teardown(version_1_says_it_in_two_files_of_two_trees, setup, teardown),
		cmocka_unit_test(cores_quota_and_memory_bound_the_workers),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
