/* outcomes.h: what came of each item: taken from the workers as it comes, reported in the items' order. */
#ifndef TOOL_BUILD_OUTCOMES_H
#define TOOL_BUILD_OUTCOMES_H

#include "build_state.h"

/* workers_result_fn; its user is the struct build. Records go to the journal. */
void outcomes_take_result(void *user, const struct job_result *result);

/* Notes that an item cannot be packed; that is reported in its turn. */
void outcomes_refuse(struct build *build, uint64_t number, const bp_error *error);

void outcomes_show_progress(const struct build *build);

#endif
