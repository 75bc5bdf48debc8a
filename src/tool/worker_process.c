/*
 * worker_process.c: one worker process and its two pipes: the protocol.
 *
 *     parent --- jobs ----> worker      one struct job_frame, then the name
 *     parent <-- results -- worker      one struct result_frame, then message_bytes + record_bytes
 *
 * Order. The parent sends a job only to a worker that has none, and the worker answers every
 * job with one result, in order. So the job pipe is empty when a job is written, a job frame
 * (300 bytes) always fits into it, and that write never blocks. Results are read as they
 * come, without blocking, into a buffer per worker. Both ends are the same program, so frames
 * are plain structs; the parent still checks magic, number and lengths, because a worker that
 * was hurt by a bad file may write anything. One that does is killed, as if it had died.
 *
 * Data. A worker opens files itself: the list of them is older than its fork. What only the parent can
 * read, because it comes one after another in a stream, it copies into a slot, a memory file that every
 * worker inherits; the job names the slot. The worker only reads it, so the data outlive the worker and a
 * second attempt needs no second copy.
 *
 * Closing. Each child closes every descriptor of its siblings' pipes, so the parent's end of a
 * job pipe is the only one: when the parent closes it or dies, the worker reads the end of file
 * and exits. PR_SET_PDEATHSIG covers a parent that is killed while the worker computes.
 *
 * Death. The result pipe's end of file says that a worker died. workers.c reaps it, forks
 * another in its place and gives it the same job once more (attempt 2); when that dies as well,
 * the job's result is an error that names the signal. A worker that cannot be replaced leaves
 * its job to the others; when none is left, waiting jobs fail.
 *
 * Signals. Workers ignore SIGINT and SIGHUP, which a terminal sends to everyone: the parent
 * decides, and ends them by SIGKILL, which is safe because they write no files.
 */
#include "worker_process.h"

#include "descriptor.h"
#include "progress.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

enum { JOB_MAGIC = 0x4a4f4231, RESULT_MAGIC = 0x52455331 };

struct job_frame {
	uint32_t magic, attempt;
	uint64_t number, slot_bytes;
	int32_t slot;
	uint32_t name_bytes; /* with the NUL */
};

struct result_frame {
	uint32_t magic, status;
	uint64_t number, offset;
	double seconds, stage_seconds[STAGE_COUNT];
	uint32_t message_bytes, record_bytes;
};

/* ---- in the worker ---- */

/*
 * Every material needs the same few tables of 6 to 35 MB. Freed memory stays in the process, so that the next
 * table finds its pages: with fresh ones, the kernel's clearing took a tenth of a build.
 */
static void keep_memory(void)
{
#ifdef __GLIBC__
	mallopt(M_MMAP_MAX, 0);
	mallopt(M_TRIM_THRESHOLD, INT_MAX);
	mallopt(M_TOP_PAD, 16 << 20);
#endif
}

/* Answers jobs until the parent closes the pipe. Never returns, and never runs the parent's exit handlers. */
static _Noreturn void worker_main(const struct worker_setup *setup, int job_fd, int result_fd)
{
	struct job_frame in;
	char name[WORKER_NAME_BYTES_MAX + 1];

	while (descriptor_read(job_fd, &in, sizeof in, -1) == sizeof in) {
		if (in.magic != JOB_MAGIC || in.name_bytes > sizeof name ||
		    descriptor_read(job_fd, name, in.name_bytes, -1) < in.name_bytes)
			_exit(1);
		struct job job = {in.number, name, in.slot, in.slot_bytes, in.attempt};
		bp_error error = {.status = BP_OK, .offset = BP_NO_OFFSET};
		uint8_t *record = NULL;
		size_t record_bytes = 0;
		struct stage_clock clock;
		double start = clock_seconds();
		stage_clock_start(&clock);
		bp_status status =
			setup->work(setup->work_user, &job, in.slot >= 0 ? setup->slot_fd[in.slot] : -1, &record, &record_bytes, &error);
		stage_clock_stop();
		struct result_frame out = {.magic = RESULT_MAGIC,
		                           .status = (uint32_t)status,
		                           .number = in.number,
		                           .offset = error.offset,
		                           .seconds = clock_seconds() - start,
		                           .message_bytes = status ? (uint32_t)strlen(error.message) : 0,
		                           .record_bytes = status ? 0 : (uint32_t)record_bytes};
		memcpy(out.stage_seconds, clock.seconds, sizeof out.stage_seconds);
		if (descriptor_write(result_fd, &out, sizeof out, -1) < sizeof out ||
		    descriptor_write(result_fd, error.message, out.message_bytes, -1) < out.message_bytes ||
		    descriptor_write(result_fd, record, out.record_bytes, -1) < out.record_bytes)
			_exit(1);
		free(record);
	}
	_exit(0);
}

/* ---- in the parent ---- */

static void worker_close(struct worker *worker)
{
	close(worker->job_fd);
	close(worker->result_fd);
	worker->pid = 0;
	worker->used = 0;
}

int worker_end(struct worker *worker)
{
	int status = 0;
	kill(worker->pid, SIGKILL); /* no harm when it is dead; its exit status stays what it was */
	while (waitpid(worker->pid, &status, 0) < 0 && errno == EINTR)
		;
	worker_close(worker);
	return status;
}

bool worker_start(const struct worker_setup *setup, struct worker *worker)
{
	int jobs[2], results[2];
	pid_t parent = getpid();

	if (pipe2(jobs, O_CLOEXEC) != 0)
		return false;
	if (pipe2(results, O_CLOEXEC) != 0) {
		close(jobs[0]);
		close(jobs[1]);
		return false;
	}
	pid_t pid = fork(); /* the child leaves by _exit, so what stands in stdio's buffers is written once */
	if (pid == 0) {
		prctl(PR_SET_PDEATHSIG, SIGKILL);
		if (getppid() != parent)
			_exit(1); /* it died before the line above */
		signal(SIGINT, SIG_IGN);
		signal(SIGHUP, SIG_IGN);
		signal(SIGTERM, SIG_DFL);
		signal(SIGPIPE, SIG_IGN);
		for (unsigned i = 0; i < setup->count; i++)
			if (setup->all[i].pid > 0)
				worker_close(&setup->all[i]);
		close(jobs[1]);
		close(results[0]);
		keep_memory();
		worker_main(setup, jobs[0], results[1]);
	}
	close(jobs[0]);
	close(results[1]);
	if (pid < 0) {
		close(jobs[1]);
		close(results[0]);
		return false;
	}
	fcntl(results[0], F_SETFL, O_NONBLOCK);
	worker->pid = pid;
	worker->job_fd = jobs[1];
	worker->result_fd = results[0];
	worker->used = 0;
	return true;
}

void worker_send(struct worker *worker, struct kept_job *kept)
{
	struct {
		struct job_frame frame;
		char name[sizeof kept->name];
	} message;
	size_t name_bytes = strlen(kept->name) + 1;

	memset(&message, 0, sizeof message.frame);
	message.frame = (struct job_frame){JOB_MAGIC,      kept->job.attempt,   kept->job.number, kept->job.slot_bytes,
	                                   kept->job.slot, (uint32_t)name_bytes};
	memcpy(message.name, kept->name, name_bytes);
	worker->current = kept;
	/* A worker that has died is noticed by its result pipe; one that lives must not wait for what never comes. */
	if (descriptor_write(worker->job_fd, &message, sizeof message.frame + name_bytes, -1) < sizeof message.frame + name_bytes)
		kill(worker->pid, SIGKILL);
}

/* What the buffer holds: 1 a whole result, 0 a part of one, -1 nonsense. */
static int result_check(const struct worker *worker, struct result_frame *frame)
{
	if (worker->used < sizeof *frame) /* nonsense may be shorter than a frame, and then nothing more comes */
		return worker->used >= sizeof frame->magic && memcmp(worker->buffer, &(uint32_t){RESULT_MAGIC}, sizeof frame->magic) ? -1
		                                                                                                                     : 0;
	memcpy(frame, worker->buffer, sizeof *frame);
	if (!worker->current || frame->magic != RESULT_MAGIC || frame->number != worker->current->job.number ||
	    frame->message_bytes >= sizeof((bp_error *)0)->message || frame->record_bytes > WORKER_RECORD_BYTES_MAX)
		return -1;
	size_t whole = sizeof *frame + frame->message_bytes + frame->record_bytes;
	return worker->used < whole ? 0 : worker->used == whole ? 1 : -1;
}

enum worker_news worker_receive(struct worker *worker, struct job_result *result)
{
	for (;;) {
		if (worker->room - worker->used < 65536) {
			size_t room = worker->room ? 2 * worker->room : 1 << 18;
			uint8_t *grown = realloc(worker->buffer, room);
			if (!grown)
				return WORKER_LOST; /* the next attempt may find memory */
			worker->buffer = grown;
			worker->room = room;
		}
		ssize_t got = read(worker->result_fd, worker->buffer + worker->used, worker->room - worker->used);
		if (got < 0 && errno == EINTR)
			continue;
		if (got < 0 && errno == EAGAIN)
			return WORKER_NOTHING;
		if (got <= 0)
			return WORKER_LOST;
		worker->used += (size_t)got;

		struct result_frame frame;
		int whole = result_check(worker, &frame);
		if (whole < 0)
			return WORKER_LOST;
		if (!whole)
			continue;
		const uint8_t *payload = worker->buffer + sizeof frame;
		*result = (struct job_result){.number = frame.number,
		                              .seconds = frame.seconds,
		                              .record = payload + frame.message_bytes,
		                              .record_bytes = frame.record_bytes};
		memcpy(result->stage_seconds, frame.stage_seconds, sizeof result->stage_seconds);
		result->error.status = (bp_status)frame.status;
		result->error.offset = frame.offset;
		memcpy(result->error.message, payload, frame.message_bytes);
		worker->used = 0;
		return WORKER_RESULT;
	}
}
