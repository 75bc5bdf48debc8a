/*
 * workers.h: worker processes that turn jobs into records. The protocol stands on top of worker_process.c.
 *
 * The parent asks for an idle worker, submits a job, and waits for results; it alone decides on
 * order and writes files. Not thread-safe; one pool per process at a time.
 */
#ifndef TOOL_WORKERS_H
#define TOOL_WORKERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "brdfpack.h"
#include "bytes.h"
#include "stage.h"

enum { WORKERS_MAX = 256, WORKER_RECORD_BYTES_MAX = 1 << 24, WORKER_NAME_BYTES_MAX = 255 };

/* One material to pack: one that the worker knows by its number, or a copy in a slot of shared memory. */
struct job {
	uint64_t number;  /* the caller's; comes back with the result */
	const char *name; /* of the material */
	int slot;         /* from workers_slot_take, or -1 */
	uint64_t slot_bytes;
	uint32_t attempt; /* 1, or 2 after a worker died; the pool sets it */
};

/* Runs in the worker: reads the file (from fd when that is not -1) and makes the record, malloc'ed. */
typedef bp_status worker_fn(void *user, const struct job *job, int fd, uint8_t **record, size_t *record_bytes, bp_error *error);

struct job_result {
	uint64_t number;
	double seconds;                    /* in the worker */
	double stage_seconds[STAGE_COUNT]; /* of its processor; stage.h */
	bp_error error;                    /* error.status BP_OK: there is a record */
	const uint8_t *record;             /* until the callback returns */
	size_t record_bytes;
};
typedef void workers_result_fn(void *user, const struct job_result *result);

struct workers;

struct workers_options {
	unsigned count;      /* processes, 1..WORKERS_MAX */
	unsigned slot_count; /* shared memory files for members of streams; 0 when there are no streams */
	worker_fn *work;
	void *work_user; /* read in the workers, as it was at the fork */
	workers_result_fn *result;
	void *result_user;
	int wake_fd; /* workers_wait also returns when this becomes readable; -1: none */
};

/* For a worker_fn: hands over what it wrote into a buffer, which is empty afterwards. BP_ERROR_MEMORY where it did not fit. */
bp_status workers_deliver(struct byte_buffer *buffer, uint8_t **record, size_t *record_bytes, bp_error *error);

/* Starts as many of the workers as the system allows; an error when that is none. */
bp_status workers_start(const struct workers_options *options, struct workers **out, bp_error *error);

bool workers_idle(const struct workers *workers);     /* a job can be submitted */
unsigned workers_busy(const struct workers *workers); /* jobs without a result so far */

/* An unused slot, or -1. The caller writes the bytes to its descriptor from offset 0. */
int workers_slot_take(struct workers *workers);
int workers_slot_fd(const struct workers *workers, int slot);
void workers_slot_release(struct workers *workers, int slot); /* only when no job was submitted with it */

/* Only when workers_idle. The strings are copied. The slot is released after the result. */
void workers_submit(struct workers *workers, const struct job *job);

/* Delivers the results that come within `milliseconds` (-1: until one comes, or a signal, or wake_fd). */
void workers_wait(struct workers *workers, int milliseconds);

/* Stops all workers at once, whatever they do, and frees; NULL is allowed. */
void workers_stop(struct workers *workers);

/*
 * All of the above for jobs that are known before: job n is names[n], or nothing where that is NULL, until all have a result or a
 * signal comes (interrupt.h, which is installed here). At most options->count processes, and no more than jobs; wake_fd is set
 * here.
 */
bp_status workers_run(const struct workers_options *options, const char *const *names, size_t count, bp_error *error);

#endif
