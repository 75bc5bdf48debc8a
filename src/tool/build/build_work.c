#include "build_state.h"

#include "archive/merge.h"
#include "codec/record_carried.h"
#include "descriptor.h"
#include "error.h"
#include "merl/sha256.h"
#include "stage.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A member of a stream: `left` bytes in a memory file, from `offset` on. */
struct slot_reader {
	int fd;
	uint64_t offset, left;
};

static bp_status slot_read(void *user, void *bytes, size_t capacity, size_t *count, bp_error *error)
{
	struct slot_reader *slot = user;
	size_t wanted = capacity < slot->left ? capacity : (size_t)slot->left;
	/* pread: the descriptor's position is shared with the parent and the other workers */
	*count = descriptor_read(slot->fd, bytes, wanted, (off_t)slot->offset);
	if (*count < wanted && errno)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot read the copied member: %s", strerror(errno));
	slot->offset += *count;
	slot->left -= *count;
	return BP_OK;
}

#ifdef BRDFPACK_TEST_HOOKS
/*
 * For tests, and in no other build: BRDFPACK_TEST_CRASH=NAME lets the worker that gets this material die of SIGSEGV;
 * NAME:1 only at the first attempt. BRDFPACK_TEST_SLEEP=SECONDS delays every material.
 */
static void test_hooks(const struct job *job)
{
	const char *crash = getenv("BRDFPACK_TEST_CRASH");
	const char *seconds = getenv("BRDFPACK_TEST_SLEEP");
	size_t name_bytes = strlen(job->name);
	if (crash && !strncmp(crash, job->name, name_bytes) &&
	    (!crash[name_bytes] || (!strcmp(crash + name_bytes, ":1") && job->attempt == 1))) {
		signal(SIGSEGV, SIG_DFL);
		raise(SIGSEGV);
	}
	if (seconds)
		sleep((unsigned)atoi(seconds));
}
#endif

static void checksum_add(void *user, const void *bytes, size_t count)
{
	const enum stage before = stage_enter(STAGE_CHECKSUM);
	sha256_add(user, bytes, count);
	stage_enter(before);
}

/* The material's record: from an interrupted build, the older archive, from the file itself, or, nearly always, by fitting. */
static bp_status record_get(const struct build *build, const char *name, const struct lattice *lattice,
                            const struct carried *carried, struct delivery *delivery, uint8_t **record, size_t *record_bytes,
                            bp_error *error)
{
	const struct fit_options *options = &build->options->fit;

	delivery->origin = RECORD_RESUMED;
	bp_status status = journal_take(&build->journal, name, &delivery->source, options, record, record_bytes, error);
	if (status || *record)
		return status;
	delivery->origin = RECORD_REUSED;
	if (build->previous)
		status = archive_reuse(build->previous, name, &delivery->source, options, record, record_bytes, error);
	if (status || *record)
		return status;
	delivery->origin = RECORD_KEPT;
	status = record_carried(lattice, carried, name, options, record, record_bytes, error);
	if (status || *record)
		return status;
	delivery->origin = RECORD_FITTED;
	return record_encode(lattice, name, &delivery->source, options, record, record_bytes, NULL, error);
}

static bool is_black(const struct lattice *lattice)
{
	for (size_t cell = 0; cell < lattice_cells(lattice->dims); cell++)
		if (lattice->valid[cell] && (lattice->rgb[0][cell] > 0 || lattice->rgb[1][cell] > 0 || lattice->rgb[2][cell] > 0))
			return false;
	return true;
}

bp_status build_work(void *user, const struct job *job, int fd, uint8_t **out, size_t *out_bytes, bp_error *error)
{
	static struct source_cursor cursor; /* this process's own: it keeps a zip open from member to member */
	const struct build *build = user;
	struct slot_reader slot = {.fd = fd, .left = job->slot_bytes};
	struct delivery delivery = {.origin = RECORD_FITTED};
	uint8_t *record = NULL;
	size_t record_bytes = 0;
	struct lattice lattice = {0};
	struct carried carried = {0};
	struct sha256 sha;
	const struct merl_reading reading = {.seen = checksum_add,
	                                     .seen_user = &sha,
	                                     .any_dims = build->options->any_lattice,
	                                     .carried = &carried,
	                                     .origin = &delivery.source.origin,
	                                     .file_bytes = &delivery.source.bytes};
	bp_status status;

#ifdef BRDFPACK_TEST_HOOKS
	test_hooks(job);
#endif
	stage_enter(STAGE_READ);
	sha256_start(&sha);
	if (fd >= 0)
		status = lattice_read(slot_read, &slot, &reading, &lattice, error);
	else
		status = source_item_read(&build->sources.items[job->number], &cursor, &reading, &lattice, error);
	if (status)
		return status;
	delivery.source.nonfinite_count = lattice.nonfinite_count;
	sha256_finish(&sha, delivery.source.sha256);
	stage_enter(STAGE_REST);
	status = lattice_take_holes(&lattice, build->options->fit.zeros, &delivery.holes, error);
	delivery.source.hole_count = (uint32_t)delivery.holes.count;
	delivery.black = !status && is_black(&lattice);
	if (!status)
		status = record_get(build, job->name, &lattice, &carried, &delivery, &record, &record_bytes, error);
	lattice_free(&lattice);
	free(carried.bytes);
	if (status)
		return status;
	struct byte_buffer whole = {0};
	write_bytes(&whole, &delivery, sizeof delivery);
	write_bytes(&whole, record, record_bytes);
	free(record);
	return workers_deliver(&whole, out, out_bytes, error);
}
