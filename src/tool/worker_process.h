/*
 * worker_process.h: one worker process, as workers.c handles it. The protocol stands on top of worker_process.c.
 */
#ifndef TOOL_WORKER_PROCESS_H
#define TOOL_WORKER_PROCESS_H

#include <sys/types.h>

#include "workers.h"

/* A job as the parent keeps it until its result is there. */
struct kept_job {
	struct job job;
	char name[WORKER_NAME_BYTES_MAX + 1];
};

struct worker {
	pid_t pid; /* 0: none */
	int job_fd, result_fd;
	struct kept_job *current; /* NULL: idle */
	uint8_t *buffer;          /* of the result that is coming in */
	size_t used, room;
};

/* What a new worker needs to know. */
struct worker_setup {
	worker_fn *work;
	void *work_user;
	struct worker *all; /* its siblings, whose pipes it closes */
	unsigned count;
	const int *slot_fd;
};

/* Forks. False when the system refuses; errno says why. */
bool worker_start(const struct worker_setup *setup, struct worker *worker);

/* Kills it if it lives, reaps it, closes its pipes; returns what waitpid says. */
int worker_end(struct worker *worker);

/* Gives it a job; it must have none. */
void worker_send(struct worker *worker, struct kept_job *kept);

/*
 * Takes in what the worker has written, without blocking. WORKER_RESULT: *result is filled, and
 * its record stays valid until the next call. WORKER_LOST: it has died or writes nonsense.
 */
enum worker_news { WORKER_NOTHING, WORKER_RESULT, WORKER_LOST };
enum worker_news worker_receive(struct worker *worker, struct job_result *result);

#endif
