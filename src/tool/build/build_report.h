/*
 * build_report.h: what a build says about each material and at the end: messages on standard
 * error, and with --json one line per material and a summary line on standard output.
 */
#ifndef TOOL_BUILD_BUILD_REPORT_H
#define TOOL_BUILD_BUILD_REPORT_H

#include <stdbool.h>

#include "codec/record.h"
#include "stage.h"
#include "build.h"
#include "items.h"

/* Where a record comes from. */
enum record_origin {
	RECORD_FITTED,
	RECORD_REUSED,  /* taken unchanged from the older archive (--update) */
	RECORD_RESUMED, /* from what an interrupted build had finished (--update, journal.h) */
	RECORD_KEPT     /* carried by its file (record_carried.h) */
};

/* What a worker delivers: this, and the record behind it. */
struct delivery {
	struct record_source source; /* the file that was read; of a record that was kept, its head has the measured one */
	struct holes holes;          /* what was made of values that stand for "not measured" */
	enum record_origin origin;
	bool black; /* every measured cell is 0 */
};

/* What became of one material: everything that its report needs. */
struct outcome {
	bp_error error; /* status BP_OK: packed, and the rest is filled */
	double seconds; /* in the worker */
	double stage_seconds[STAGE_COUNT];
	struct record_head head;
	struct delivery delivery;
};

struct build_totals {
	uint64_t packed, refused; /* materials */
	uint64_t missing;         /* materials that the manifest lists and no input has */
	uint64_t damaged;         /* inputs that could not be read, or not to their end, or that hold no material */
	uint64_t skipped;         /* what was passed over without a loss; only a warning */
	uint64_t reused, kept;    /* of the packed ones, by their records' origin; what was resumed is reused */
	uint64_t source_bytes, archive_bytes;
	double seconds;
};

/* Nothing that was asked for is left out. */
static inline bool totals_whole(const struct build_totals *totals)
{
	return totals->refused == 0 && totals->missing == 0 && totals->damaged == 0;
}

/*
 * An input, or (with a name) a material, that is not packed, and why: a message, and with --json a line. The one place that says
 * so.
 */
void report_unpacked(const char *label, const char *name, const bp_error *error, bool json);

/* Something that was passed over without a loss, as far as is known: a warning, and with --json a line. */
void report_passed_over(const char *path, const char *reason, bool json, bool quiet);

void report_material(const struct item *item, const struct outcome *outcome, bool json, bool quiet);

/*
 * After everything: what was passed over, in one line, with the names of texts of licences. More text only when something went
 * wrong; without counts when the build was stopped before its end.
 */
void report_summary(const struct build_options *options, bool written, bool stopped, const struct build_totals *totals,
                    const struct source_list *sources);

#endif
