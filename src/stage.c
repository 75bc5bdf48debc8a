#include "stage.h"

#include <stddef.h>
#include <time.h>

_Thread_local struct stage_clock *stage_clock_running;

const char *stage_name(enum stage stage)
{
	static const char *const NAMES[STAGE_COUNT] = {"rest", "read", "checksum", "clean", "regression", "transform", "code", "measure"};
	return NAMES[stage];
}

static double thread_seconds(void)
{
	struct timespec now;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void stage_clock_start(struct stage_clock *clock)
{
	*clock = (struct stage_clock){.now = STAGE_REST, .since = thread_seconds()};
	stage_clock_running = clock;
}

enum stage stage_switch(enum stage stage)
{
	struct stage_clock *clock = stage_clock_running;
	const enum stage before = clock->now;
	const double now = thread_seconds();
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
