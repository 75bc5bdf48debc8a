/* The finished records of a build beside its output: what a kill leaves of them, and what is never touched. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include <fcntl.h>
#include <math.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "memory_limit.h"
#include "packed_fixture.h"
#include "scratch.h"
#include "tool/build/journal.h"

static const struct fit_options OPTIONS = {.profile = PROFILE_SPECTRAL, .budget_bytes = 2000, .effort = 5};
static char folder[SCRATCH_BYTES], output[SCRATCH_BYTES + 32], remark[JOURNAL_REMARK_BYTES];

static int folder_make(void **state)
{
	(void)state;
	assert_int_equal(scratch_folder(folder), 0);
	snprintf(output, sizeof output, "%s/out.bpk", folder);
	return 0;
}

static int folder_remove(void **state)
{
	(void)state;
	return rmdir(folder); /* a test leaves nothing */
}

struct packed {
	uint8_t *bytes;
	size_t count;
	struct record_source source;
};

static struct packed pack(const char *name, uint8_t mark)
{
	struct lattice lattice;
	struct packed out = {.source = {.bytes = 1000, .sha256 = {mark}}};
	glossy_lattice_make((struct lattice_dims){6, 6, 8}, 1 + mark, &lattice);
	assert_int_equal(record_encode(&lattice, name, &out.source, &OPTIONS, &out.bytes, &out.count, NULL, NULL), BP_OK);
	lattice_free(&lattice);
	return out;
}

static struct journal open_with(const struct fit_options *options, bool resume)
{
	struct journal journal;
	bp_error error;
	assert_int_equal(journal_open(output, options, resume, &journal, remark, &error), BP_OK);
	return journal;
}

static void add(struct journal *journal, const struct packed *packed)
{
	uint64_t offset;
	bp_error error;
	uint8_t *back = malloc(packed->count);
	assert_int_equal(journal_add(journal, packed->bytes, packed->count, &offset, &error), BP_OK);
	assert_int_equal(journal_read(journal, offset, back, (uint32_t)packed->count, &error), BP_OK);
	assert_memory_equal(back, packed->bytes, packed->count);
	free(back);
}

/* Whether the record of this source and these options is found, and is this one. */
static bool takes(const struct journal *journal, const char *name, const struct record_source *source,
                  const struct fit_options *options, const struct packed *expected)
{
	uint8_t *record;
	size_t count = 0;
	bp_error error;
	assert_int_equal(journal_take(journal, name, source, options, &record, &count, &error), BP_OK);
	if (record) {
		assert_int_equal(count, expected->count);
		assert_memory_equal(record, expected->bytes, count);
	}
	free(record);
	return record != NULL;
}

static void the_next_build_goes_on(void **state)
{
	(void)state;
	struct packed alpha = pack("alpha", 1), beta = pack("beta", 2), later = pack("alpha", 3);
	struct fit_options other = OPTIONS;
	other.effort = 4;

	struct journal journal = open_with(&OPTIONS, true);
	assert_string_equal(remark, "");
	assert_int_equal(journal_count(&journal), 0);
	add(&journal, &beta);
	add(&journal, &alpha);
	add(&journal, &later);
	assert_null(journal_find(&journal, "alpha")); /* found are those of an older build */
	journal_close(&journal, true);

	journal = open_with(&OPTIONS, true);
	assert_string_equal(remark, "");
	assert_int_equal(journal_count(&journal), 3);
	assert_true(takes(&journal, "beta", &beta.source, &OPTIONS, &beta));
	assert_true(takes(&journal, "alpha", &later.source, &OPTIONS, &later)); /* the latest of a name counts */
	assert_false(takes(&journal, "alpha", &alpha.source, &OPTIONS, &alpha));
	assert_false(takes(&journal, "beta", &alpha.source, &OPTIONS, &beta)); /* another file */
	assert_false(takes(&journal, "beta", &beta.source, &other, &beta));
	assert_false(takes(&journal, "gamma", &beta.source, &OPTIONS, &beta));
	journal_close(&journal, true);

	journal = open_with(&other, true);
	assert_non_null(strstr(remark, "other options"));
	assert_int_equal(journal_count(&journal), 0);
	add(&journal, &beta);
	journal_close(&journal, true);
	journal = open_with(&other, false);
	assert_non_null(strstr(remark, "--update would have"));
	assert_int_equal(journal_count(&journal), 0);
	journal_close(&journal, true); /* empty: not kept */
	free(alpha.bytes);
	free(beta.bytes);
	free(later.bytes);
}

static size_t file_bytes(const char *path)
{
	struct stat about;
	return stat(path, &about) == 0 ? (size_t)about.st_size : 0;
}

static void byte_flip(const char *path, size_t at)
{
	uint8_t byte;
	const int fd = open(path, O_RDWR);
	assert_int_equal(pread(fd, &byte, 1, (off_t)at), 1);
	byte ^= 0x10;
	assert_int_equal(pwrite(fd, &byte, 1, (off_t)at), 1);
	close(fd);
}

static void what_is_torn_is_dropped(void **state)
{
	(void)state;
	struct packed alpha = pack("alpha", 1), beta = pack("beta", 2);
	struct journal journal = open_with(&OPTIONS, true);
	char *path = strdup(journal.path);
	add(&journal, &alpha);
	const size_t first = (size_t)journal.bytes;
	add(&journal, &beta);
	journal_close(&journal, true);
	const size_t whole = file_bytes(path);

	for (size_t at = JOURNAL_HEADER_BYTES; at < whole; at += 7) { /* one bit wrong */
		byte_flip(path, at);
		uint8_t *bytes = malloc(whole);
		int fd = open(path, O_RDONLY);
		assert_int_equal(read(fd, bytes, whole), whole);
		close(fd);
		journal = open_with(&OPTIONS, true);
		assert_int_equal(journal_count(&journal), at < first ? 0 : 1);
		assert_non_null(strstr(remark, "dropped"));
		if (at >= first)
			assert_true(takes(&journal, "alpha", &alpha.source, &OPTIONS, &alpha));
		close(journal.fd); /* as a kill would */
		journal.fd = -1;
		journal_close(&journal, true);
		fd = open(path, O_WRONLY | O_TRUNC);
		assert_int_equal(write(fd, bytes, whole), whole);
		close(fd);
		byte_flip(path, at);
		free(bytes);
	}
	for (size_t left = whole - 1; left > 0; left = left > first ? left - 13 : left - 1) { /* torn */
		assert_int_equal(truncate(path, (off_t)left), 0);
		journal = open_with(&OPTIONS, true);
		assert_int_equal(journal_count(&journal), left >= first);
		close(journal.fd);
		journal.fd = -1;
		journal_close(&journal, true);
		if (left < first)
			break;
		assert_int_equal(file_bytes(path), first);
		assert_int_equal(truncate(path, (off_t)left), 0); /* zeros behind, as after a power cut */
	}
	for (size_t left = 0; left < JOURNAL_HEADER_BYTES; left += 3) { /* not even a header */
		assert_int_equal(truncate(path, (off_t)left), 0);
		journal = open_with(&OPTIONS, true);
		assert_int_equal(journal_count(&journal), 0);
		assert_int_equal(file_bytes(path), JOURNAL_HEADER_BYTES);
		close(journal.fd);
		journal.fd = -1;
		journal_close(&journal, true);
	}
	unlink(path);
	free(path);
	free(alpha.bytes);
	free(beta.bytes);
}

/* An entry whose record wants more memory than there is: of what stands in the file nothing is lost, before it and behind. */
static void a_journal_that_cannot_be_read_stays(void **state)
{
	(void)state;
	struct packed alpha = pack("alpha", 1);
	for (int whole_before = 0; whole_before < 2; whole_before++) {
		struct journal journal = open_with(&OPTIONS, true);
		char *path = strdup(journal.path);
		bp_error error;
		if (whole_before)
			add(&journal, &alpha);
		const uint8_t head[JOURNAL_ENTRY_BYTES] = JOURNAL_MARK "\0\0\0\1"; /* 16 MB */
		assert_int_equal(pwrite(journal.fd, head, sizeof head, (off_t)journal.bytes), sizeof head);
		assert_int_equal(ftruncate(journal.fd, (off_t)journal.bytes + (20 << 20)), 0);
		const size_t bytes = file_bytes(path);
		close(journal.fd); /* as a kill would */
		journal.fd = -1;
		journal_close(&journal, true);
		assert_true(memory_limit(8 << 20));
		assert_int_equal(journal_open(output, &OPTIONS, true, &journal, remark, &error), BP_ERROR_MEMORY);
		assert_true(memory_limit(0));
		assert_int_equal(file_bytes(path), bytes);
		unlink(path);
		free(path);
	}
	free(alpha.bytes);
}

static void a_changed_journal_is_noticed(void **state)
{
	(void)state;
	struct packed alpha = pack("alpha", 1);
	struct journal journal = open_with(&OPTIONS, true);
	bp_error error;
	uint64_t offset;
	assert_int_equal(journal_add(&journal, alpha.bytes, alpha.count, &offset, &error), BP_OK);
	uint8_t byte;
	assert_int_equal(pread(journal.fd, &byte, 1, (off_t)offset + 5), 1);
	byte ^= 1;
	assert_int_equal(pwrite(journal.fd, &byte, 1, (off_t)offset + 5), 1);
	uint8_t *back = malloc(alpha.count);
	assert_int_equal(journal_read(&journal, offset, back, (uint32_t)alpha.count, &error), BP_ERROR_IO);
	assert_non_null(strstr(error.message, "another build"));
	assert_int_equal(journal_read(&journal, offset + 1000000, back, 8, &error), BP_ERROR_IO);
	free(back);
	journal_close(&journal, false);
	journal_close(&journal, false);
	free(alpha.bytes);
}

static void what_is_in_the_way_stays(void **state)
{
	(void)state;
	struct packed alpha = pack("alpha", 1);
	struct journal journal = open_with(&OPTIONS, true);
	char *path = strdup(journal.path);
	journal_close(&journal, false);
	assert_int_equal(access(path, F_OK), -1);

	const int fd = open(path, O_WRONLY | O_CREAT, 0600);
	assert_int_equal(write(fd, "a diary", 7), 7);
	close(fd);
	journal = open_with(&OPTIONS, true);
	assert_non_null(strstr(remark, "in the way"));
	assert_null(journal.path);
	add(&journal, &alpha); /* it works as well */
	journal_close(&journal, true);
	assert_int_equal(file_bytes(path), 7);
	unlink(path);

	assert_int_equal(symlink("elsewhere", path), 0);
	journal = open_with(&OPTIONS, true);
	assert_non_null(strstr(remark, "in the way"));
	journal_close(&journal, true);
	unlink(path);
	assert_int_equal(mkdir(path, 0700), 0);
	journal = open_with(&OPTIONS, true);
	assert_non_null(strstr(remark, "in the way"));
	journal_close(&journal, true);
	rmdir(path);

	/* what took the name while it ran */
	journal = open_with(&OPTIONS, true);
	unlink(path);
	close(open(path, O_WRONLY | O_CREAT, 0600));
	journal_close(&journal, false);
	assert_int_equal(access(path, F_OK), 0);
	unlink(path);
	free(path);
	free(alpha.bytes);

	bp_error error;
	assert_int_equal(journal_open("/nowhere/at/all.bpk", &OPTIONS, true, &journal, remark, &error), BP_ERROR_IO);
}

static void two_builds_do_not_share_it(void **state)
{
	(void)state;
	struct packed alpha = pack("alpha", 1);
	int ready[2], done[2];
	char byte = 0;
	assert_int_equal(pipe(ready) | pipe(done), 0);
	const pid_t other = fork();
	if (other == 0) { /* a build that is killed */
		struct journal journal = open_with(&OPTIONS, true);
		add(&journal, &alpha);
		(void)!write(ready[1], "", 1);
		(void)!read(done[0], &byte, 1);
		_exit(0);
	}
	assert_int_equal(read(ready[0], &byte, 1), 1);
	struct journal journal = open_with(&OPTIONS, true);
	assert_non_null(strstr(remark, "another build"));
	assert_null(journal.path);
	add(&journal, &alpha);
	assert_int_equal(journal_count(&journal), 0); /* none that a next build would find */
	journal_close(&journal, true);
	assert_int_equal(write(done[1], "", 1), 1);
	waitpid(other, NULL, 0);
	journal = open_with(&OPTIONS, true);
	assert_int_equal(journal_count(&journal), 1);
	assert_true(takes(&journal, "alpha", &alpha.source, &OPTIONS, &alpha));
	journal_close(&journal, false);
	free(alpha.bytes);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(the_next_build_goes_on, folder_make, folder_remove),
		cmocka_unit_test_setup_teardown(what_is_torn_is_dropped, folder_make, folder_remove),
		cmocka_unit_test_setup_teardown(a_journal_that_cannot_be_read_stays, folder_make, folder_remove),
		cmocka_unit_test_setup_teardown(a_changed_journal_is_noticed, folder_make, folder_remove),
		cmocka_unit_test_setup_teardown(what_is_in_the_way_stays, folder_make, folder_remove),
		cmocka_unit_test_setup_teardown(two_builds_do_not_share_it, folder_make, folder_remove),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
