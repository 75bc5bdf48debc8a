/*
 * build.h: measured files -> archive: which files, in what order, by which worker, and what is
 * said about them. The inputs' order and the number of workers change nothing in the archive.
 */
#ifndef TOOL_BUILD_BUILD_H
#define TOOL_BUILD_BUILD_H

#include <stdbool.h>

#include "model/model.h"

struct build_options {
	const char *output;
	char **inputs;
	int input_count;
	const char *manifest; /* NULL: none */
	struct fit_options fit;
	unsigned workers;
	bool strict, json, quiet;
	bool update;                 /* take records of unchanged sources from the archive that stands at `output` */
	unsigned shard, shard_count; /* pack the shard-th (1..shard_count) part of the materials, chosen by their names; 0, 0: all */
	const char *charset;         /* of names in tars and zips that are not UTF-8; NULL: unknown */
	bool force;                  /* replace an output that is an input, or no archive */
	bool any_lattice;            /* accept MERL-like files of any legal extents */
};

/* Returns an exit code; everything has been said. */
int build_run(const struct build_options *options);

#endif
