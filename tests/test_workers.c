/* Worker processes, with work that needs no measured files. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "error.h"
#include "tool/cores.h"
#include "tool/workers.h"

enum { JOBS = 40 };

static struct {
	int count[JOBS];
	bp_error error[JOBS];
	char record[JOBS][64];
	size_t record_bytes[JOBS];
} seen;

static void remember(void *user, const struct job_result *result)
{
	(void)user;
	assert_in_range(result->number, 0, JOBS - 1);
	seen.count[result->number]++;
	seen.error[result->number] = result->error;
	seen.record_bytes[result->number] = result->record_bytes;
	size_t kept = result->record_bytes < 63 ? result->record_bytes : 63;
	if (!result->error.status && kept)
		memcpy(seen.record[result->number], result->record, kept);
}

/* The record is the name; some names do something else. */
static bp_status work(void *user, const struct job *job, int fd, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	(void)user;
	if (!strcmp(job->name, "bad"))
		return error_set(error, BP_ERROR_BAD_INPUT, 17, "found %s", job->name);
	if (!strcmp(job->name, "crash") || (!strcmp(job->name, "crash-once") && job->attempt == 1)) {
		signal(SIGSEGV, SIG_DFL);
		raise(SIGSEGV);
	}
	if (!strcmp(job->name, "exit"))
		_exit(7);
	if (!strcmp(job->name, "nonsense")) { /* writes to every descriptor it can reach, its result pipe among them */
		for (int i = 3; i < 64; i++)
			(void)!write(i, "nonsensenonsensenonsensenonsensenonsensenonsensenonsense", 56);
		pause();
	}
	*record_bytes = !strcmp(job->name, "large") ? 5000000 : strlen(job->name);
	*record = calloc(1, *record_bytes + 1);
	if (fd >= 0)
		*record_bytes = (size_t)pread(fd, *record, (size_t)job->slot_bytes, 0);
	else
		memcpy(*record, job->name, strlen(job->name));
	return BP_OK;
}

static struct workers *start(unsigned count, unsigned slots)
{
	struct workers *workers = NULL;
	struct workers_options options = {.count = count, .slot_count = slots, .work = work, .result = remember, .wake_fd = -1};
	bp_error error;
	memset(&seen, 0, sizeof seen);
	assert_int_equal(workers_start(&options, &workers, &error), BP_OK);
	return workers;
}

static void submit(struct workers *workers, unsigned number, const char *name)
{
	while (!workers_idle(workers))
		workers_wait(workers, -1);
	struct job job = {.number = number, .name = name, .slot = -1};
	workers_submit(workers, &job);
}

static void finish(struct workers *workers)
{
	while (workers_busy(workers) > 0)
		workers_wait(workers, -1);
	workers_stop(workers);
}

static void every_job_gets_one_result(void **state)
{
	(void)state;
	for (unsigned count = 1; count <= 3; count++) {
		struct workers *workers = start(count, 0);
		for (unsigned i = 0; i < JOBS; i++) {
			char name[16];
			snprintf(name, sizeof name, "m%u", i);
			submit(workers, i, name);
		}
		finish(workers);
		for (unsigned i = 0; i < JOBS; i++) {
			char name[16];
			snprintf(name, sizeof name, "m%u", i);
			assert_int_equal(seen.count[i], 1);
			assert_string_equal(seen.record[i], name);
		}
	}
}

static void an_error_comes_back_with_its_offset(void **state)
{
	(void)state;
	struct workers *workers = start(2, 0);
	submit(workers, 0, "bad");
	submit(workers, 1, "good");
	finish(workers);
	assert_int_equal(seen.error[0].status, BP_ERROR_BAD_INPUT);
	assert_int_equal(seen.error[0].offset, 17);
	assert_string_equal(seen.error[0].message, "found bad");
	assert_int_equal(seen.error[1].status, BP_OK);
}

static void a_record_may_be_larger_than_a_pipe(void **state)
{
	(void)state;
	struct workers *workers = start(1, 0);
	submit(workers, 0, "large");
	finish(workers);
	assert_int_equal(seen.record_bytes[0], 5000000);
	assert_string_equal(seen.record[0], "large");
}

static void a_worker_that_dies_once_is_replaced_and_its_job_repeated(void **state)
{
	(void)state;
	struct workers *workers = start(1, 0);
	submit(workers, 0, "a");
	submit(workers, 1, "crash-once");
	submit(workers, 2, "b");
	finish(workers);
	assert_int_equal(seen.error[1].status, BP_OK);
	assert_string_equal(seen.record[1], "crash-once");
	assert_string_equal(seen.record[2], "b");
}

static void a_worker_that_dies_twice_is_reported_with_its_signal(void **state)
{
	(void)state;
	struct workers *workers = start(2, 0);
	submit(workers, 0, "crash");
	submit(workers, 1, "exit");
	submit(workers, 2, "b");
	finish(workers);
	assert_non_null(strstr(seen.error[0].message, "signal 11"));
	assert_non_null(strstr(seen.error[1].message, "exit code 7"));
	assert_string_equal(seen.record[2], "b");
	assert_int_equal(seen.count[0] + seen.count[1] + seen.count[2], 3);
}

static void a_worker_that_writes_nonsense_is_stopped(void **state)
{
	(void)state;
	struct workers *workers = start(1, 0);
	submit(workers, 0, "nonsense");
	submit(workers, 1, "b");
	finish(workers);
	assert_int_not_equal(seen.error[0].status, BP_OK);
	assert_string_equal(seen.record[1], "b");
}

static void a_slot_carries_bytes_also_to_the_second_attempt(void **state)
{
	(void)state;
	struct workers *workers = start(2, 3);
	int slot = workers_slot_take(workers);
	assert_int_equal(pwrite(workers_slot_fd(workers, slot), "in the slot", 11, 0), 11);
	struct job job = {.number = 0, .name = "crash-once", .slot = slot, .slot_bytes = 11};
	workers_submit(workers, &job);
	int other = workers_slot_take(workers), third = workers_slot_take(workers);
	assert_int_not_equal(other, slot);
	assert_int_equal(workers_slot_take(workers), -1);
	workers_slot_release(workers, other);
	workers_slot_release(workers, third);
	while (workers_busy(workers) > 0)
		workers_wait(workers, -1);
	assert_string_equal(seen.record[0], "in the slot");
	for (int i = 0; i < 3; i++)
		assert_int_not_equal(workers_slot_take(workers), -1); /* released after the result */
	workers_stop(workers);
}

static void stopping_does_not_wait_for_the_work(void **state)
{
	(void)state;
	struct workers *workers = start(2, 0);
	submit(workers, 0, "nonsense");
	workers_stop(workers);
	workers_stop(NULL);
}

static void a_name_that_is_too_long_is_an_error_of_that_job(void **state)
{
	(void)state;
	char name[WORKER_NAME_BYTES_MAX + 10] = "";
	struct workers *workers = start(1, 0);
	memset(name, 'p', sizeof name - 1);
	struct job job = {.number = 0, .name = name, .slot = -1};
	workers_submit(workers, &job);
	finish(workers);
	assert_int_equal(seen.error[0].status, BP_ERROR_BAD_INPUT);
}

static void at_least_one_core_is_usable(void **state)
{
	(void)state;
	assert_in_range(cores_usable(), 1, WORKERS_MAX);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_job_gets_one_result),
		cmocka_unit_test(an_error_comes_back_with_its_offset),
		cmocka_unit_test(a_record_may_be_larger_than_a_pipe),
		cmocka_unit_test(a_worker_that_dies_once_is_replaced_and_its_job_repeated),
		cmocka_unit_test(a_worker_that_dies_twice_is_reported_with_its_signal),
		cmocka_unit_test(a_worker_that_writes_nonsense_is_stopped),
		cmocka_unit_test(a_slot_carries_bytes_also_to_the_second_attempt),
		cmocka_unit_test(stopping_does_not_wait_for_the_work),
		cmocka_unit_test(a_name_that_is_too_long_is_an_error_of_that_job),
		cmocka_unit_test(at_least_one_core_is_usable),
	};
	signal(SIGPIPE, SIG_IGN);
	return cmocka_run_group_tests(tests, NULL, NULL);
}
