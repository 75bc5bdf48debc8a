/* build_inputs.h: inputs become items for the workers: what is listed, and members of streams as they are read. */
#ifndef TOOL_BUILD_BUILD_INPUTS_H
#define TOOL_BUILD_BUILD_INPUTS_H

#include "build_state.h"

/* Fills sources and items. Reports what is skipped or refused. */
void build_inputs_collect(struct build *build);

/*
 * Reads on in the streams until a member is in a slot (*job is ready to submit; true) or all are
 * at their end (false). Takes in the workers' results meanwhile.
 */
bool build_inputs_next(struct build *build, struct job *job);

#endif
