/*
 * build_state.h: what the files build*.c share while a build runs.
 *
 *     build.c         the phases: collect, work, write
 *     build_inputs.c  inputs -> items and streams; members of streams -> slots and items
 *     build_work.c    what a worker does with a job
 *     build_report.c  what is said
 */
#ifndef TOOL_BUILD_BUILD_STATE_H
#define TOOL_BUILD_BUILD_STATE_H

#include "build.h"
#include "build_report.h"
#include "items.h"
#include "manifest.h"
#include "spool.h"
#include "tool/workers.h"

/* What a worker delivers: this, and the record behind it. */
struct delivery {
	struct record_source source; /* the file that was read; of a record that was kept, its head has the measured one */
	enum record_origin origin;
};

struct build {
	const struct build_options *options;
	struct manifest manifest;
	struct source_list sources;
	bool scanned;            /* sources is filled */
	struct items items;      /* those that workers read themselves, by name; then members of streams as they turn up */
	size_t listed_count;     /* of items, the former: item i is sources.items[i] */
	size_t submitted;        /* of these, the ones that were handed to workers */
	size_t reported;         /* items whose outcome has been reported: always the first ones */
	struct container *stream; /* the stream that is being read */
	size_t stream_next;      /* the stream after it, in sources.streams */
	struct workers *workers;
	struct spool spool;
	struct build_totals totals;
	uint64_t bytes_total, bytes_done; /* of the listed items, for the progress bar */
	bp_archive *previous;    /* with --update, the archive that is there already; else NULL */
	bool stopped;            /* after an error that ends the build; it has been reported */
};

/* True when the build goes on: no error that ends it, no signal. */
bool build_goes_on(const struct build *build);

/* Reports an error that ends the build. */
void build_stop(struct build *build, const char *file, const char *material, const bp_error *error);

/* Notes that an item cannot be packed; that is reported in its turn. */
void build_refuse(struct build *build, uint64_t number, const bp_error *error);

/* ---- build_inputs.c ---- */

/* Fills sources and items. Reports what is skipped; stops the build at an illegal or double name. */
void build_inputs_collect(struct build *build);

/*
 * Reads on in the streams until a member is in a slot (*job is ready to submit; true) or all are
 * at their end (false). Takes in the workers' results meanwhile.
 */
bool build_stream_next(struct build *build, struct job *job);

/* ---- build_work.c ---- */

worker_fn build_work; /* its user is the struct build, as it was when the worker was forked; it makes a delivery */

#endif
