/* build_work.h: what a worker does with a job: read, check, and make a record. */
#ifndef TOOL_BUILD_BUILD_WORK_H
#define TOOL_BUILD_BUILD_WORK_H

#include "build_state.h"

/* What a worker delivers: this, and the record behind it. */
struct delivery {
	struct record_source source; /* the file that was read; of a record that was kept, its head has the measured one */
	struct holes holes;          /* what was made of values that stand for "not measured" */
	enum record_origin origin;
};

worker_fn build_work; /* its user is the struct build, as it was when the worker was forked; it makes a delivery */

#endif
