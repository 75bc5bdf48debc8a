/*
 * Files that appear whole or not at all, in each manner: without a name until they are complete, where the file system has no
 * such thing, and where it may not be named. open, linkat and fsync stand before libc's, so that they can fail here.
 */
#include "archive_fixture.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "bytes.h"
#include "output_file.h"

static bool names_only;                   /* a file system without O_TMPFILE */
static bool links_barred;                 /* a container that lets no file be named by its descriptor */
static int folder_refusal, fsync_refusal; /* errno of opening, of syncing a folder; 0: it works */

int open(const char *path, int flags, ...)
{
	va_list more;
	va_start(more, flags);
	const mode_t mode = flags & (O_CREAT | __O_TMPFILE) ? va_arg(more, mode_t) : 0;
	va_end(more);
	if (names_only && (flags & O_TMPFILE) == O_TMPFILE)
		return errno = EOPNOTSUPP, -1;
	if (folder_refusal && (flags & O_TMPFILE) == O_DIRECTORY)
		return errno = folder_refusal, -1;
	return openat(AT_FDCWD, path, flags, mode);
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
	if (links_barred && flags & AT_SYMLINK_FOLLOW)
		return errno = EPERM, -1;
	return (int)syscall(SYS_linkat, from_folder, from, to_folder, to, flags);
}

int fsync(int fd)
{
	struct stat about;
	if (fsync_refusal && fstat(fd, &about) == 0 && S_ISDIR(about.st_mode))
		return errno = fsync_refusal, -1;
	return (int)syscall(SYS_fsync, fd);
}

static int files_in_folder(void) { return scratch_count(fixture_folder); }

static bp_status put(const char *path, enum output_rule rule, const char *text, bp_error *error)
{
	struct output_file file;
	bp_status status = output_file_open(path, rule, &file, error);
	if (!status)
		status = output_file_write(&file, text, strlen(text), error);
	if (!status)
		status = output_file_commit(&file, error);
	output_file_discard(&file);
	return status;
}

static void expect(const char *path, const char *text)
{
	size_t count;
	uint8_t *bytes = fixture_file_read(path, &count);
	assert_int_equal(count, strlen(text));
	assert_memory_equal(bytes, text, count);
	free(bytes);
}

static mode_t mode_of(const char *path)
{
	struct stat about;
	assert_int_equal(lstat(path, &about), 0);
	return about.st_mode & 07777;
}

/* Every test below runs in three manners. */
static int with_names(void **state)
{
	(void)state;
	names_only = true;
	links_barred = false;
	return 0;
}
static int without_names(void **state)
{
	(void)state;
	names_only = links_barred = false;
	return 0;
}
static int by_copies(void **state)
{
	(void)state;
	names_only = false;
	links_barred = true;
	return 0;
}

static void a_rule_says_what_may_be_replaced(void **state)
{
	const char *path = fixture_path("file");
	bp_error error;
	(void)state;
	assert_int_equal(put(path, OUTPUT_COMPARE, "one", &error), BP_ERROR_IO);
	assert_int_equal(put(path, OUTPUT_NEW, "one", &error), BP_OK);
	assert_int_equal(put(path, OUTPUT_NEW, "two", &error), BP_ERROR_ARGUMENT);
	assert_non_null(strstr(error.message, "file: is there already"));
	assert_int_equal(put(path, OUTPUT_COMPARE, "one", &error), BP_OK);
	assert_int_equal(put(path, OUTPUT_COMPARE, "on", &error), BP_ERROR_ARGUMENT);
	assert_int_equal(put(path, OUTPUT_COMPARE, "ones", &error), BP_ERROR_ARGUMENT);
	assert_int_equal(put(path, OUTPUT_COMPARE, "oNe", &error), BP_ERROR_ARGUMENT);
	expect(path, "one");
	assert_int_equal(put(path, OUTPUT_REPLACE, "two", &error), BP_OK);
	expect(path, "two");
	assert_int_equal(files_in_folder(), 1);
	unlink(path);
}

static void what_appears_meanwhile_is_not_replaced(void **state)
{
	const char *path = fixture_path("file");
	struct output_file file;
	(void)state;
	assert_int_equal(output_file_open(path, OUTPUT_NEW, &file, NULL), BP_OK);
	assert_int_equal(output_file_write(&file, "ours", 4, NULL), BP_OK);
	fixture_file_write(path, "theirs", 6);
	assert_int_equal(output_file_commit(&file, NULL), BP_ERROR_ARGUMENT);
	expect(path, "theirs");
	assert_int_equal(files_in_folder(), 1);
	unlink(path);
}

static void mode_and_owner_are_kept(void **state)
{
	const char *path = fixture_path("file");
	static const mode_t modes[] = {0600, 0640, 0444, 0755};
	struct stat about;
	(void)state;
	for (size_t n = 0; n < sizeof modes / sizeof *modes; n++) {
		fixture_file_write(path, "old", 3);
		assert_int_equal(chmod(path, modes[n]), 0);
		if (geteuid() == 0)
			assert_int_equal(chown(path, 65534, 12345), 0);
		assert_int_equal(put(path, OUTPUT_REPLACE, "new", NULL), BP_OK);
		expect(path, "new");
		assert_int_equal(mode_of(path), modes[n]);
		assert_int_equal(stat(path, &about), 0);
		if (geteuid() == 0) {
			assert_int_equal(about.st_uid, 65534);
			assert_int_equal(about.st_gid, 12345);
		}
		unlink(path);
	}
	const mode_t mask = umask(027);
	assert_int_equal(put(path, OUTPUT_REPLACE, "new", NULL), BP_OK);
	umask(mask);
	assert_int_equal(mode_of(path), 0640);
	unlink(path);
}

static void a_link_is_followed_and_one_to_nothing_refused(void **state)
{
	const char *real = fixture_path("real"), *link = fixture_path("link");
	bp_error error;
	(void)state;
	fixture_file_write(real, "old", 3);
	assert_int_equal(symlink("real", link), 0);
	assert_int_equal(put(link, OUTPUT_REPLACE, "new", NULL), BP_OK);
	expect(real, "new");
	struct stat about;
	assert_int_equal(lstat(link, &about), 0);
	assert_true(S_ISLNK(about.st_mode));
	assert_int_equal(put(link, OUTPUT_COMPARE, "new", NULL), BP_OK);
	assert_int_equal(put(link, OUTPUT_NEW, "other", NULL), BP_ERROR_ARGUMENT);
	unlink(real);
	assert_int_equal(put(link, OUTPUT_REPLACE, "new", &error), BP_ERROR_IO);
	assert_non_null(strstr(error.message, "a link that leads to nothing"));
	assert_int_equal(put(link, OUTPUT_NEW, "new", &error), BP_ERROR_IO);
	unlink(link);
	assert_int_equal(files_in_folder(), 0);
}

static void the_longest_name_can_be_written_and_a_longer_one_is_refused_at_once(void **state)
{
	char name[300];
	struct output_file file;
	bp_error error;
	(void)state;
	memset(name, 'x', sizeof name);
	name[255] = '\0';
	assert_int_equal(put(fixture_path(name), OUTPUT_REPLACE, "long", NULL), BP_OK);
	expect(fixture_path(name), "long");
	unlink(fixture_path(name));
	name[255] = 'x';
	name[256] = '\0';
	assert_int_equal(output_file_open(fixture_path(name), OUTPUT_REPLACE, &file, &error), BP_ERROR_IO);
	assert_non_null(strstr(error.message, "too long"));
}

static void a_folder_that_cannot_be_synced_is_a_warning(void **state)
{
	const char *path = fixture_path("file");
	static const int reasons[] = {EACCES, EOPNOTSUPP, ENOSYS, EIO};
	(void)state;
	for (int way = 0; way < 2; way++)
		for (size_t n = 0; n < sizeof reasons / sizeof *reasons; n++) {
			struct output_file file;
			bp_error error = {.message = "of before"};
			*(way ? &fsync_refusal : &folder_refusal) = reasons[n];
			assert_int_equal(output_file_open(path, OUTPUT_REPLACE, &file, &error), BP_OK);
			assert_int_equal(output_file_write(&file, "new", 3, &error), BP_OK);
			assert_int_equal(output_file_commit_synced(&file, &error), BP_OK);
			assert_int_equal(error.status, BP_OK);
			assert_non_null(strstr(error.message, "written, but its folder cannot be synced"));
			assert_non_null(strstr(error.message, strerror(reasons[n])));
			fsync_refusal = folder_refusal = 0;
			expect(path, "new");
			unlink(path);
		}
	struct output_file file;
	bp_error error = {.message = "of before"};
	assert_int_equal(output_file_open(path, OUTPUT_REPLACE, &file, NULL), BP_OK);
	assert_int_equal(output_file_commit_synced(&file, &error), BP_OK);
	assert_string_equal(error.message, "");
	unlink(path);
}

/* Files that are called as ours may be, but are not: the next writer goes round them, and leaves them. */
static void nobody_else_s_file_is_touched(void **state)
{
	char name[64], path[512];
	(void)state;
	strcpy(path, fixture_path("out.bpk"));
	for (unsigned n = 0; n < 400; n++) {
		snprintf(name, sizeof name, ".brdfpack-%08x-%ld-%u", bytes_crc32("out.bpk", 7), (long)getpid(), n);
		fixture_file_write(fixture_path(name), "precious", 8);
	}
	snprintf(name, sizeof name, ".brdfpack-%08x-1-0", bytes_crc32("out.bpk", 7));
	fixture_file_write(fixture_path(name), "precious, and longer than what a sweep looks at, which is the first sixty-four bytes",
	                   80);
	static const char *const names[] = {"a", "b"};
	fixture_archive(path, names, 2, 100);
	fixture_archive(path, names, 2, 100);
	assert_int_equal(files_in_folder(), 402);
	for (unsigned n = 0; n < 400; n++) {
		snprintf(name, sizeof name, ".brdfpack-%08x-%ld-%u", bytes_crc32("out.bpk", 7), (long)getpid(), n);
		expect(fixture_path(name), "precious");
		unlink(fixture_path(name));
	}
	snprintf(name, sizeof name, ".brdfpack-%08x-1-0", bytes_crc32("out.bpk", 7));
	unlink(fixture_path(name));
	unlink(path);
}

static void what_a_killed_writer_left_goes_with_the_next_run_but_not_a_living_ones(void **state)
{
	static const char *const names[] = {"brass", "chrome", "delrin"};
	const char *path = fixture_path("out.bpk");
	const unsigned named = names_only; /* files that a writer at work shows */
	int ready[2], result;
	char byte;
	(void)state;
	assert_int_equal(pipe(ready), 0);
	const pid_t child = fork();
	if (child == 0) {
		struct archive_writer *writer = NULL;
		if (archive_writer_open(path, &writer, NULL) == BP_OK && write(ready[1], "x", 1) == 1)
			pause();
		_exit(1);
	}
	assert_int_equal(read(ready[0], &byte, 1), 1);
	assert_int_equal(files_in_folder(), named);
	fixture_archive(path, names, 3, 4); /* the other lives: its file stays */
	assert_int_equal(files_in_folder(), 1 + named);
	kill(child, SIGKILL);
	assert_int_equal(waitpid(child, &result, 0), child);
	assert_int_equal(files_in_folder(), 1 + named);
	fixture_archive(path, names, 3, 4);
	assert_int_equal(files_in_folder(), 1);
	close(ready[0]);
	close(ready[1]);
	unlink(path);
}

static void a_scratch_file_has_no_name(void **state)
{
	int fd;
	char back[6] = "";
	(void)state;
	assert_int_equal(output_scratch_open(fixture_path("out"), &fd, NULL), BP_OK);
	assert_int_equal(files_in_folder(), 0);
	assert_int_equal(pwrite(fd, "hello", 5, 3), 5);
	assert_int_equal(pread(fd, back, 5, 3), 5);
	assert_string_equal(back, "hello");
	close(fd);
	assert_int_equal(output_scratch_open(fixture_path("none/out"), &fd, NULL), BP_ERROR_IO);
}

#define EACH(test) \
	cmocka_unit_test_setup(test, without_names), {#test " (named)", test, with_names, NULL, NULL}, \
	{ \
#test " (copied)", test, by_copies, NULL, NULL \
	}

int main(void)
{
	const struct CMUnitTest tests[] = {
		EACH(a_rule_says_what_may_be_replaced),
		EACH(what_appears_meanwhile_is_not_replaced),
		EACH(mode_and_owner_are_kept),
		EACH(a_link_is_followed_and_one_to_nothing_refused),
		EACH(the_longest_name_can_be_written_and_a_longer_one_is_refused_at_once),
		EACH(a_folder_that_cannot_be_synced_is_a_warning),
		EACH(nobody_else_s_file_is_touched),
		EACH(what_a_killed_writer_left_goes_with_the_next_run_but_not_a_living_ones),
		EACH(a_scratch_file_has_no_name),
	};
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
