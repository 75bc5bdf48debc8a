/*
 * merge.h: records from archive to archive, as they are: subset, merge, and reuse by a later build.
 *
 * Sections are copied byte for byte; what is read is checked. The result depends on nothing but its inputs, and
 * appears under its name only when it is whole (writer.h), so it may replace one of its own inputs. BP_OK may come with a
 * warning in *error, as from archive_writer_commit.
 */
#ifndef ARCHIVE_MERGE_H
#define ARCHIVE_MERGE_H

#include <stdbool.h>

#include "reader.h"

struct copy_options {
	const char *output;
	double max_log_rmse; /* > 0: the fewest layers whose log RMSE of what is seen is at most this, all where none is; 0: all */
	bool replace;        /* merge: of a name that several inputs have, take the last input's; otherwise that is refused */
	/* merge: above 0, the inputs are the shards of one build into this many: refuse one that is not, or is there twice, and
	   records of other options, profile or codec version than the first one's. An input without a material may be any shard */
	uint32_t shards;
	bool (*stop)(void); /* asked before every record; true: nothing is written, *stopped is set. NULL: never */
};

struct copy_totals {
	uint64_t copied;               /* materials written */
	uint64_t replaced;             /* left out because a later input has the name */
	uint64_t trimmed;              /* copied with fewer layers than they had */
	uint64_t bytes_from, bytes_to; /* of their records, before and after */
	bool stopped;
	bool reading;                            /* after an error: it is about an input, not about the output */
	char damaged[RECORD_NAME_BYTES_MAX + 1]; /* after an error: the material whose record cannot be read, or empty */
};

/*
 * Writes materials index[0..count-1] of one archive (strictly ascending; NULL: all of them) to another.
 * Errors: those of reader and writer; BP_ERROR_ARGUMENT where count is 0.
 */
bp_status archive_subset(const struct bp_archive *archive, const uint64_t *index, uint64_t count,
                         const struct copy_options *options, struct copy_totals *totals, bp_error *error);

/*
 * Writes all materials of `count` archives to one. A name in two of them is BP_ERROR_BAD_INPUT, naming both, unless
 * options->replace. *failed is the input that an error is about when totals->reading.
 */
bp_status archive_merge(const struct bp_archive *const *archives, size_t count, const struct copy_options *options,
                        struct copy_totals *totals, size_t *failed, bp_error *error);

/*
 * A record that was made from the same source (SHA-256 and size) with the same options by the codec version of this
 * program. Looks for `name` in the archive; *record is malloc'ed, or NULL when there is none to reuse, be it damaged,
 * of another source or not there: then it has to be made anew.
 */
bp_status archive_reuse(const struct bp_archive *archive, const char *name, const struct record_source *source,
                        const struct fit_options *options, uint8_t **record, size_t *record_bytes, bp_error *error);

#endif
