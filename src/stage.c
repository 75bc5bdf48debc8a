#include "stage.h"

#include <stddef.h>

#include "system.h"

_Thread_local struct stage_clock *stage_clock_running;

const char *stage_name(enum stage stage)
{
	static const char *const NAMES[STAGE_COUNT] = {"rest",       "read",      "checksum", "clean",
	                                               "regression", "transform", "code",     "measure"};
	return NAMES[stage];
}

void stage_clock_start(struct stage_clock *clock)
{
	*clock = (struct stage_clock){.now = STAGE_REST, .since = system_thread_seconds()};
	stage_clock_running = clock;
}

enum stage stage_switch(enum stage stage)
{
	struct stage_clock *clock = stage_clock_running;
	const enum stage before = clock->now;
	const double now = system_thread_seconds();
	clock->seconds[before] += now - clock->since;
	clock->since = now;
	clock->now = stage;
	return before;
}

void stage_clock_stop(void)
{
	stage_enter(STAGE_REST);
	stage_clock_running = NULL;
}
