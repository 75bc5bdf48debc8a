#include "build_inputs.h"

#include "descriptor.h"
#include "error.h"
#include "merl/rgl_file.h"
#include "merl/two_halves.h"
#include "outcomes.h"
#include "tool/report.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* An input, as a whole or from here on. */
static void damage_take(struct build *build, const char *path, const bp_error *error)
{
	report_unpacked(path, NULL, error, build->options->json);
	build->totals.damaged++;
}

static void notice_take(void *user, enum source_notice kind, const char *path, const char *reason)
{
	struct build *build = user;
	if (kind == SOURCE_DAMAGED) {
		bp_error error;
		error_set(&error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s", reason);
		damage_take(build, path, &error);
	} else {
		report_passed_over(path, reason, build->options->json, build->options->quiet);
		build->totals.skipped++;
	}
}

static void refusal_take(void *user, const struct source_item *source, const char *reason)
{
	struct build *build = user;
	char label[ITEM_LABEL_BYTES];
	bp_error error;
	error_set(&error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s", reason);
	item_label(source, label);
	report_unpacked(label, source->name, &error, build->options->json);
	build->totals.refused++;
}

/* Listed, where there is a manifest, and of this shard, where there are shards. */
static bool is_wanted(void *user, const char *name)
{
	struct build *build = user;
	struct manifest_entry *entry = manifest_find(&build->manifest, name);
	if (entry)
		entry->found = true;
	else
		manifest_note_unlisted(&build->manifest, name);
	return (entry || build->manifest.count == 0) && build_shard_has(build->options, name);
}

/* Files by name; members of a container where it stands first, in their order: who goes back in it reads it from the start. */
static int order_compare(const void *a, const void *b, void *user)
{
	const struct source_item *items = user, *x = &items[*(const size_t *)a], *y = &items[*(const size_t *)b];
	const int path = x->member && y->member ? strcmp(x->path, y->path) : (x->member != NULL) - (y->member != NULL);
	if (path != 0)
		return path;
	if (x->member)
		return (x->ordinal > y->ordinal) - (x->ordinal < y->ordinal);
	return x < y ? -1 : x > y;
}

static bp_status order_make(struct build *build, bp_error *error)
{
	const size_t count = build->listed_count;
	build->order = malloc((count + 1) * sizeof *build->order);
	if (!build->order)
		return error_memory(error, count * sizeof *build->order);
	for (size_t n = 0; n < count; n++)
		build->order[n] = n;
	qsort_r(build->order, count, sizeof *build->order, order_compare, build->sources.items);
	return BP_OK;
}

void build_inputs_collect(struct build *build)
{
	const struct source_options options = {.notice = notice_take,
	                                       .refused = refusal_take,
	                                       .charset = build->options->charset,
	                                       .wanted =
	                                           build->manifest.count > 0 || build->options->shard_count > 1 ? is_wanted : NULL,
	                                       .user = build};
	bp_error error;

	const bp_status status = source_scan((const char *const *)build->options->inputs, (size_t)build->options->input_count,
	                                     &options, &build->sources, &error);
	if (build_stops(build, NULL, status, &error))
		return;
	build->scanned = true;
	for (size_t i = 0; i < build->sources.item_count; i++) {
		if (build_stops(build, NULL, items_add(&build->items, &build->sources.items[i], false, &error), &error))
			return;
		build->bytes_total += item_weight(&build->sources.items[i]);
	}
	build->listed_count = build->items.count;
	build_stops(build, NULL, order_make(build, &error), &error);
}

/* Opens streams until one has a next member. */
static bool member_find(struct build *build, struct source_item *member)
{
	bp_error error;
	while (build_goes_on(build)) {
		if (!build->stream) {
			if (build->stream_next == build->sources.stream_count)
				return false;
			const char *path = build->sources.streams[build->stream_next++].path;
			if (container_open(path, CONTAINER_SEQUENTIAL, build->options->charset, &build->stream, &error)) {
				build->stream = NULL;
				damage_take(build, path, &error);
				continue;
			}
		}
		const size_t stream = build->stream_next - 1;
		bool more = false;
		bp_status status = source_stream_next(&build->sources, stream, build->stream, member, &more, &error);
		if (status && member->name) {
			const size_t number = build->items.count;
			if (!build_stops(build, NULL, items_add(&build->items, member, true, &error), &error))
				outcomes_refuse(build, number, &error);
		} else if (status) {
			damage_take(build, build->sources.streams[stream].path, &error);
		} else if (more) {
			return true;
		} else {
			container_close(build->stream);
			build->stream = NULL;
		}
	}
	return false;
}

/* One byte more than the largest file that can be right: so a worker sees that there is more. */
static uint64_t member_bytes_most(const struct build *build)
{
	const uint64_t halves = two_halves_bytes(), tensor = RGL_FILE_BYTES_MAX;
	const uint64_t table = build->options->any_lattice ? 12 + 24 * (uint64_t)LATTICE_CELLS_MAX : halves;
	return (table > tensor ? table : tensor) + 1;
}

/* Copies the member into the slot; *bytes is how much. */
static bp_status member_copy(struct build *build, int fd, uint64_t *bytes, bp_error *error)
{
	enum { CHUNK = 1 << 20 };
	uint64_t most = member_bytes_most(build), done = 0;
	bp_status status = BP_OK;
	uint8_t *chunk = malloc(CHUNK);
	if (!chunk)
		return error_memory(error, CHUNK);
	while (done < most && build_goes_on(build)) {
		size_t wanted = most - done < CHUNK ? (size_t)(most - done) : CHUNK, got = 0;
		status = container_read(build->stream, chunk, wanted, &got, error);
		if (status || got == 0)
			break;
		if (descriptor_write(fd, chunk, got, (off_t)done) < got) {
			status = error_set(error, BP_ERROR_MEMORY, BP_NO_OFFSET, "cannot keep the member in memory: %s", strerror(errno));
			break;
		}
		done += got;
		workers_wait(build->workers, 0); /* their pipes should not run full meanwhile */
	}
	free(chunk);
	*bytes = done;
	return status;
}

bool build_inputs_next(struct build *build, struct job *job)
{
	struct source_item member;
	bp_error error;

	while (build_goes_on(build) && member_find(build, &member)) {
		int slot;
		while ((slot = workers_slot_take(build->workers)) < 0 && build_goes_on(build))
			workers_wait(build->workers, -1);
		size_t number = build->items.count;
		if (build_stops(build, NULL, items_add(&build->items, &member, true, &error), &error) || slot < 0)
			return false;
		*job = (struct job){.number = number, .name = build->items.item[number].source.name, .slot = slot};
		bp_status status = member_copy(build, workers_slot_fd(build->workers, slot), &job->slot_bytes, &error);
		if (!status)
			return build_goes_on(build);
		workers_slot_release(build->workers, slot);
		outcomes_refuse(build, number, &error);
	}
	return false;
}
