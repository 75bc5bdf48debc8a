/*
 * build_state.h: what is known while a build runs.
 *
 *     build.c         the phases: collect, work, write
 *     build_inputs.c  inputs -> items and streams; members of streams -> slots and items
 *     build_work.c    what a worker does with a job
 *     outcomes.c      what came of the items
 *     journal.c       where finished records are until the archive is written, or until the next build
 *     build_report.c  what is said
 */
#ifndef TOOL_BUILD_BUILD_STATE_H
#define TOOL_BUILD_BUILD_STATE_H

#include "build.h"
#include "build_report.h"
#include "items.h"
#include "journal.h"
#include "manifest.h"
#include "name.h"
#include "tool/interrupt.h"
#include "tool/report.h"
#include "tool/workers.h"

struct build {
	const struct build_options *options;
	struct manifest manifest;
	struct source_list sources;
	bool scanned;             /* sources is filled */
	struct items items;       /* those that workers read themselves, by name; then members of streams as they turn up */
	size_t listed_count;      /* of items, the former: item i is sources.items[i] */
	size_t *order;            /* of the listed items, the order in which workers get them */
	size_t submitted;         /* of these, how many were handed to workers */
	size_t reported;          /* items whose outcome has been reported: always the first ones */
	struct container *stream; /* the stream that is being read */
	size_t stream_next;       /* the stream after it, in sources.streams */
	struct workers *workers;
	struct journal journal;
	struct build_totals totals;
	uint64_t bytes_total, bytes_done; /* of the listed items, for the progress bar */
	bp_archive *previous;             /* with --update, the archive that is there already; else NULL */
	bool stopped;                     /* after an error that ends the build; it has been reported */
};

/* True when the build goes on: no error that ends it, no signal. */
static inline bool build_goes_on(const struct build *build) { return !build->stopped && !interrupt_signal(); }

/* Reports an error that ends the build. */
static inline void build_stop(struct build *build, const char *file, const bp_error *error)
{
	report_error(file, NULL, error);
	build->stopped = true;
}

/*
 * Whether a material of this name belongs to the shard. Names alone decide, so the shards of any count are disjoint and together
 * all there is.
 */
static inline bool build_shard_has(const struct build_options *options, const char *name)
{
	return options->shard_count <= 1 || name_shard(name, options->shard_count) == options->shard;
}

worker_fn build_work; /* its user is the struct build, as it was when the worker was forked; it makes a delivery */

#endif
