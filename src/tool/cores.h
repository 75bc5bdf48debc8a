/*
 * cores.h: how many workers are as good as there can be: by processor cores, and by memory.
 */
#ifndef TOOL_CORES_H
#define TOOL_CORES_H

/* What control groups allow; INFINITY where they say nothing. */
struct cores_limits {
	double cores; /* processors that the quota pays for */
	double bytes; /* of memory */
};

/*
 * The least of a process's groups and of all groups around them, versions 1 and 2 (Linux,
 * Documentation/admin-guide/cgroup-v2.rst): root is where they are mounted, groups the process's list (/proc/self/cgroup).
 */
struct cores_limits cores_limits_read(const char *root, const char *groups);

/* 1 to WORKERS_MAX: at most the cores and what a quota pays for, rounded up, and one worker to 160 MB beyond the first 100. */
unsigned cores_allowed(unsigned cores, double machine_bytes, struct cores_limits limits);

/* The same of this process: its affinity mask, the machine's memory, its control groups. */
unsigned cores_usable(void);

#endif
