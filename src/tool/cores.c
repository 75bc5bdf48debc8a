#include "cores.h"

#include "workers.h"

#include <sched.h>
#include <stdio.h>

/* The processors that the control group's quota pays for, rounded up; 0 without a quota. */
static unsigned quota_cores(void)
{
	double quota, period;
	FILE *file = fopen("/sys/fs/cgroup/cpu.max", "re"); /* version 2: "QUOTA PERIOD" or "max PERIOD", in microseconds */
	int fields = file ? fscanf(file, "%lf %lf", &quota, &period) : 0;
	if (file)
		fclose(file);
	return fields == 2 && quota > 0 && period > 0 && quota / period < WORKERS_MAX ? (unsigned)(quota / period + 0.999) : 0;
}

unsigned cores_usable(void)
{
	cpu_set_t set;
	unsigned cores = 1;
	if (sched_getaffinity(0, sizeof set, &set) == 0)
		cores = (unsigned)CPU_COUNT(&set);
	unsigned quota = quota_cores();
	if (quota > 0 && quota < cores)
		cores = quota;
	return cores < 1 ? 1 : cores > WORKERS_MAX ? WORKERS_MAX : cores;
}
