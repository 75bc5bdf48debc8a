/*
 * workers.c: the pool: which worker gets which job, and what happens when one dies. How parent
 * and workers talk stands on top of worker_process.c.
 */
#include "workers.h"

#include "error.h"
#include "interrupt.h"
#include "report.h"
#include "worker_process.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { ATTEMPTS = 2 };

struct workers {
	struct workers_options options;
	struct worker_setup setup;
	struct worker worker[WORKERS_MAX];
	struct kept_job *again[WORKERS_MAX]; /* jobs that wait for an idle worker: a new one, or those whose worker died */
	unsigned again_count;
	int slot_fd[WORKERS_MAX + 1];
	bool slot_taken[WORKERS_MAX + 1];
};

static void job_finish(struct workers *pool, struct kept_job *kept, const struct job_result *result)
{
	pool->options.result(pool->options.result_user, result);
	if (kept->job.slot >= 0)
		pool->slot_taken[kept->job.slot] = false;
	free(kept);
}

static void job_fail(struct workers *pool, struct kept_job *kept, const char *how)
{
	struct job_result result = {.number = kept->job.number};
	error_set(&result.error, BP_ERROR_IO, BP_NO_OFFSET, "%s", how);
	job_finish(pool, kept, &result);
}

static struct worker *worker_find_idle(struct workers *pool)
{
	for (unsigned i = 0; i < pool->options.count; i++)
		if (pool->worker[i].pid > 0 && !pool->worker[i].current)
			return &pool->worker[i];
	return NULL;
}

static bool workers_alive(const struct workers *pool)
{
	for (unsigned i = 0; i < pool->options.count; i++)
		if (pool->worker[i].pid > 0)
			return true;
	return false;
}

static void again_send(struct workers *pool)
{
	struct worker *worker;
	while (pool->again_count > 0 && (worker = worker_find_idle(pool)))
		worker_send(worker, pool->again[--pool->again_count]);
	while (pool->again_count > 0 && !workers_alive(pool))
		job_fail(pool, pool->again[--pool->again_count], "no worker process could be started; free some memory and try again");
}

static void death_describe(int status, char *text, size_t bytes)
{
	if (WIFSIGNALED(status))
		snprintf(text, bytes, "the worker died twice on it, of signal %d (%s)%s", WTERMSIG(status), strsignal(WTERMSIG(status)),
		         WTERMSIG(status) == SIGKILL ? "; if memory ran out, use fewer workers (-j)" : "");
	else
		snprintf(text, bytes, "the worker died twice on it, with exit code %d", WIFEXITED(status) ? WEXITSTATUS(status) : -1);
}

/* Buries a worker, and replaces it. Its job comes next, or fails when this was the second time. */
static void worker_replace(struct workers *pool, struct worker *worker)
{
	struct kept_job *kept = worker->current;
	int status = worker_end(worker);
	worker->current = NULL;
	worker_start(&pool->setup, worker);
	if (kept && kept->job.attempt < ATTEMPTS) {
		kept->job.attempt++;
		pool->again[pool->again_count++] = kept;
	} else if (kept) {
		char how[200];
		death_describe(status, how, sizeof how);
		job_fail(pool, kept, how);
	}
	again_send(pool);
}

static void news_take(struct workers *pool, struct worker *worker)
{
	struct job_result result;
	switch (worker_receive(worker, &result)) {
	case WORKER_NOTHING: break;
	case WORKER_LOST: worker_replace(pool, worker); break;
	case WORKER_RESULT: {
		struct kept_job *kept = worker->current;
		worker->current = NULL;
		job_finish(pool, kept, &result);
		again_send(pool);
		break;
	}
	}
}

bp_status workers_start(const struct workers_options *options, struct workers **out, bp_error *error)
{
	struct workers *pool = calloc(1, sizeof *pool);
	bool any = false;
	if (!pool)
		return error_memory(error, sizeof *pool);
	pool->options = *options;
	report_workers = options->count > 1;
	pool->setup = (struct worker_setup){options->work, options->work_user, pool->worker, options->count, pool->slot_fd};
	for (unsigned i = 0; i < options->slot_count; i++)
		pool->slot_fd[i] = -1;
	for (unsigned i = 0; i < options->slot_count; i++) {
		pool->slot_fd[i] = memfd_create("brdfpack-member", MFD_CLOEXEC);
		if (pool->slot_fd[i] < 0) {
			error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot create a memory file: %s", strerror(errno));
			goto out;
		}
	}
	for (unsigned i = 0; i < options->count; i++)
		any |= worker_start(&pool->setup, &pool->worker[i]);
	if (any) {
		*out = pool;
		return BP_OK;
	}
	error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot start a worker process: %s", strerror(errno));
out:
	workers_stop(pool);
	return BP_ERROR_IO;
}

bool workers_idle(const struct workers *pool) { return worker_find_idle((struct workers *)pool) || !workers_alive(pool); }

unsigned workers_busy(const struct workers *pool)
{
	unsigned busy = pool->again_count;
	for (unsigned i = 0; i < pool->options.count; i++)
		busy += pool->worker[i].current != NULL;
	return busy;
}

int workers_slot_take(struct workers *pool)
{
	for (unsigned i = 0; i < pool->options.slot_count; i++)
		if (!pool->slot_taken[i]) {
			pool->slot_taken[i] = true;
			return (int)i;
		}
	return -1;
}

int workers_slot_fd(const struct workers *pool, int slot) { return pool->slot_fd[slot]; }

void workers_slot_release(struct workers *pool, int slot) { pool->slot_taken[slot] = false; }

void workers_submit(struct workers *pool, const struct job *job)
{
	struct job_result result = {.number = job->number};
	struct kept_job *kept = malloc(sizeof *kept);
	if (!kept || strlen(job->name) >= sizeof kept->name) {
		if (!kept)
			error_memory(&result.error, sizeof *kept);
		else
			error_set(&result.error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "the name has more than %d bytes", WORKER_NAME_BYTES_MAX);
		free(kept);
		pool->options.result(pool->options.result_user, &result);
		if (job->slot >= 0)
			pool->slot_taken[job->slot] = false;
		return;
	}
	kept->job = *job;
	kept->job.attempt = 1;
	strcpy(kept->name, job->name);
	pool->again[pool->again_count++] = kept;
	again_send(pool);
}

void workers_wait(struct workers *pool, int milliseconds)
{
	struct pollfd watched[WORKERS_MAX + 1];
	struct worker *owner[WORKERS_MAX + 1];
	nfds_t count = 0;

	for (unsigned i = 0; i < pool->options.count; i++)
		if (pool->worker[i].pid > 0) {
			owner[count] = &pool->worker[i];
			watched[count++] = (struct pollfd){.fd = pool->worker[i].result_fd, .events = POLLIN};
		}
	nfds_t workers_watched = count;
	if (pool->options.wake_fd >= 0)
		watched[count++] = (struct pollfd){.fd = pool->options.wake_fd, .events = POLLIN};
	if (poll(watched, count, milliseconds) <= 0)
		return;
	for (nfds_t i = 0; i < workers_watched; i++)
		if (watched[i].revents)
			news_take(pool, owner[i]);
}

void workers_stop(struct workers *pool)
{
	if (!pool)
		return;
	for (unsigned i = 0; i < pool->options.count; i++) {
		struct worker *worker = &pool->worker[i];
		if (worker->pid > 0)
			worker_end(worker);
		free(worker->current);
		free(worker->buffer);
	}
	while (pool->again_count > 0)
		free(pool->again[--pool->again_count]);
	for (unsigned i = 0; i < pool->options.slot_count; i++)
		if (pool->slot_fd[i] >= 0)
			close(pool->slot_fd[i]);
	free(pool);
}

bp_status workers_run(const struct workers_options *options, const char *const *names, size_t count, bp_error *error)
{
	struct workers_options pool = *options;
	struct workers *workers;
	size_t wanted = 0;
	for (size_t n = 0; n < count; n++)
		wanted += names[n] != NULL;
	if (wanted == 0)
		return BP_OK;
	if (wanted < pool.count)
		pool.count = (unsigned)wanted;
	bp_status status = interrupt_install(&pool.wake_fd, error);
	if (status == BP_OK)
		status = workers_start(&pool, &workers, error);
	if (status != BP_OK)
		return status;
	for (size_t n = 0; n < count && !interrupt_signal(); n++) {
		while (names[n] && !workers_idle(workers) && !interrupt_signal())
			workers_wait(workers, -1);
		if (names[n] && !interrupt_signal())
			workers_submit(workers, &(struct job){.number = n, .name = names[n], .slot = -1});
	}
	while (workers_busy(workers) && !interrupt_signal())
		workers_wait(workers, -1);
	workers_stop(workers);
	return BP_OK;
}
