#include "archive_fixture.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

static const char *const NAMES[] = {"brass", "chrome", "delrin"};

static int files_in_folder(void) { return scratch_count(fixture_folder); }

static void the_same_records_give_the_same_bytes(void **state)
{
	size_t a_bytes, b_bytes;
	uint8_t *a, *b;
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 3, 100);
	fixture_archive(fixture_path("b.bpk"), NAMES, 3, 100);
	a = fixture_file_read(fixture_path("a.bpk"), &a_bytes);
	b = fixture_file_read(fixture_path("b.bpk"), &b_bytes);
	assert_int_equal(a_bytes, b_bytes);
	assert_memory_equal(a, b, a_bytes);
	assert_memory_equal(a,
	                    "\x8b"
	                    "BPK\r\n\x1a\n",
	                    8);
	assert_int_equal(files_in_folder(), 2);
	free(a);
	free(b);
	unlink(fixture_path("a.bpk"));
	unlink(fixture_path("b.bpk"));
}

static void nothing_stands_under_the_name_before_commit(void **state)
{
	const char *path = fixture_path("late.bpk");
	struct archive_writer *writer = NULL;
	size_t bytes;
	uint8_t *record = fixture_record("m", 1, 4, &bytes);
	(void)state;
	assert_int_equal(archive_writer_open(path, &writer, NULL), BP_OK);
	assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_OK);
	assert_int_equal(access(path, F_OK), -1);
	archive_writer_discard(writer);
	assert_int_equal(files_in_folder(), 0);
	archive_writer_discard(NULL);
	free(record);
}

static void names_that_do_not_ascend_are_refused(void **state)
{
	struct archive_writer *writer = NULL;
	size_t bytes, low_bytes;
	uint8_t *record = fixture_record("m", 1, 4, &bytes), *low = fixture_record("a", 1, 4, &low_bytes);
	(void)state;
	assert_int_equal(archive_writer_open(fixture_path("x.bpk"), &writer, NULL), BP_OK);
	assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_OK);
	assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(archive_writer_add(writer, low, low_bytes, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(archive_writer_add(writer, record, bytes - 1, NULL), BP_ERROR_ARGUMENT);
	archive_writer_discard(writer);
	free(record);
	free(low);
}

static void an_output_that_cannot_be_made_is_named(void **state)
{
	struct archive_writer *writer = NULL;
	bp_error error;
	(void)state;
	assert_int_equal(archive_writer_open(fixture_path("missing/x.bpk"), &writer, &error), BP_ERROR_IO);
	assert_non_null(strstr(error.message, "missing/x.bpk"));
	assert_int_equal(archive_writer_open(fixture_folder, &writer, &error), BP_ERROR_IO);
	assert_non_null(strstr(error.message, "folder"));
	assert_int_equal(archive_writer_open("/dev/null", &writer, &error), BP_ERROR_IO);
	assert_int_equal(archive_writer_open("", &writer, &error), BP_ERROR_ARGUMENT);
	assert_int_equal(symlink("/nowhere/at/all", fixture_path("dangling")), 0);
	assert_int_equal(archive_writer_open(fixture_path("dangling"), &writer, &error), BP_ERROR_IO);
	unlink(fixture_path("dangling"));
	assert_null(writer);
	assert_int_equal(files_in_folder(), 0);
}

static void a_link_is_followed(void **state)
{
	struct stat found;
	(void)state;
	fixture_archive(fixture_path("real.bpk"), NAMES, 1, 4);
	assert_int_equal(symlink(fixture_path("real.bpk"), fixture_path("link.bpk")), 0);
	fixture_archive(fixture_path("link.bpk"), NAMES, 3, 4);
	assert_int_equal(lstat(fixture_path("link.bpk"), &found), 0);
	assert_true(S_ISLNK(found.st_mode));
	assert_int_equal(files_in_folder(), 2);
	unlink(fixture_path("real.bpk"));
	unlink(fixture_path("link.bpk"));
}

/* A limit on the file's size stands in for a full disk. */
static void a_full_disk_leaves_the_old_archive_untouched(void **state)
{
	const char *path = fixture_path("old.bpk");
	size_t before_bytes, after_bytes;
	uint8_t *before, *after;
	int result;
	pid_t child;
	(void)state;
	fixture_archive(path, NAMES, 3, 4);
	before = fixture_file_read(path, &before_bytes);
	child = fork();
	if (child == 0) {
		struct rlimit limit = {300000, 300000};
		struct archive_writer *writer = NULL;
		size_t bytes;
		uint8_t *record = fixture_record("a", 1, 1000000, &bytes);
		bp_error error = {0};
		signal(SIGXFSZ, SIG_IGN);
		setrlimit(RLIMIT_FSIZE, &limit);
		bp_status status = archive_writer_open(path, &writer, &error);
		if (!status)
			status = archive_writer_add(writer, record, bytes, &error);
		archive_writer_discard(writer);
		_exit(status == BP_ERROR_IO && strstr(error.message, "old.bpk") ? 0 : 1);
	}
	assert_int_equal(waitpid(child, &result, 0), child);
	assert_int_equal(result, 0);
	after = fixture_file_read(path, &after_bytes);
	assert_int_equal(before_bytes, after_bytes);
	assert_memory_equal(before, after, before_bytes);
	assert_int_equal(files_in_folder(), 1);
	free(before);
	free(after);
	unlink(path);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_same_records_give_the_same_bytes),
		cmocka_unit_test(nothing_stands_under_the_name_before_commit),
		cmocka_unit_test(names_that_do_not_ascend_are_refused),
		cmocka_unit_test(an_output_that_cannot_be_made_is_named),
		cmocka_unit_test(a_link_is_followed),
		cmocka_unit_test(a_full_disk_leaves_the_old_archive_untouched),
	};
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
