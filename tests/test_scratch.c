/* scratch.h: tests' files lie where TMPDIR says, and nothing of them stays. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "scratch.h"

static char *before; /* TMPDIR as it came */

static int environment_keep(void **state)
{
	(void)state;
	before = getenv("TMPDIR") ? strdup(getenv("TMPDIR")) : NULL;
	return 0;
}

static int environment_restore(void **state)
{
	(void)state;
	const int code = before ? setenv("TMPDIR", before, 1) : unsetenv("TMPDIR");
	free(before);
	return code;
}

static void files_and_folders_lie_in_tmpdir_and_go_with_all_they_hold(void **state)
{
	(void)state;
	char parent[SCRATCH_BYTES], folder[SCRATCH_BYTES], file[SCRATCH_BYTES];
	assert_int_equal(scratch_folder(parent), 0);
	assert_int_equal(setenv("TMPDIR", parent, 1), 0);
	assert_int_equal(scratch_folder(folder), 0);
	assert_int_equal(scratch_file(file), 0);
	assert_int_equal(scratch_count(parent), 2);
	assert_true(!strncmp(folder, parent, strlen(parent)) && !strncmp(file, parent, strlen(parent)));
	assert_int_equal(mkdir(scratch_in(folder, "within"), 0700), 0);
	assert_int_equal(symlink("/", scratch_in(folder, "link")), 0);
	assert_int_equal(scratch_remove(parent), 0);
	assert_int_equal(scratch_count(parent), -1);
}

static void without_tmpdir_it_is_tmp_and_one_that_is_too_long_is_refused(void **state)
{
	(void)state;
	char path[SCRATCH_BYTES], longer[SCRATCH_BYTES + 1];
	assert_int_equal(unsetenv("TMPDIR"), 0);
	assert_string_equal(scratch_parent(), "/tmp");
	assert_int_equal(setenv("TMPDIR", "", 1), 0);
	assert_string_equal(scratch_parent(), "/tmp");
	memset(longer, 'x', SCRATCH_BYTES);
	longer[SCRATCH_BYTES] = '\0';
	assert_int_equal(setenv("TMPDIR", longer, 1), 0);
	assert_int_equal(scratch_folder(path), -1);
	assert_int_equal(errno, ENAMETOOLONG);
	assert_int_equal(scratch_file(path), -1);
	assert_int_equal(errno, ENAMETOOLONG);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(files_and_folders_lie_in_tmpdir_and_go_with_all_they_hold, environment_keep,
	                                    environment_restore),
		cmocka_unit_test_setup_teardown(without_tmpdir_it_is_tmp_and_one_that_is_too_long_is_refused, environment_keep,
	                                    environment_restore),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
