#include "cores.h"

#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "workers.h"

enum { PATH_BYTES = 4096 };
static const double WORKER_BYTES = 160e6; /* the largest seen is 121 MB */
static const double BASE_BYTES = 100e6;   /* the parent, with members of streams in shared memory */

/* The numbers at the start of a file of a control group; how many there are. "max" counts as none. */
static int numbers_read(const char *folder, const char *name, double *first, double *second)
{
	char path[PATH_BYTES];
	if ((size_t)snprintf(path, sizeof path, "%s/%s", folder, name) >= sizeof path)
		return 0;
	FILE *file = fopen(path, "re");
	const int count = file ? fscanf(file, "%lf %lf", first, second) : 0;
	if (file)
		fclose(file);
	return count < 0 ? 0 : count;
}

static void limits_of(const char *folder, struct cores_limits *limits)
{
	double a, b, c, d;
	double cores = INFINITY, bytes = INFINITY;
	if (numbers_read(folder, "cpu.max", &a, &b) == 2 && b > 0) /* version 2: "QUOTA PERIOD" or "max PERIOD", microseconds */
		cores = a / b;
	if (numbers_read(folder, "cpu.cfs_quota_us", &a, &b) >= 1 && numbers_read(folder, "cpu.cfs_period_us", &c, &d) >= 1 &&
	    a > 0 && c > 0)
		cores = fmin(cores, a / c); /* version 1 */
	if (numbers_read(folder, "memory.max", &a, &b) >= 1)
		bytes = a;
	if (numbers_read(folder, "memory.limit_in_bytes", &a, &b) >= 1)
		bytes = fmin(bytes, a); /* version 1; without a limit a number beyond any memory */
	limits->cores = fmin(limits->cores, cores);
	limits->bytes = fmin(limits->bytes, bytes);
}

/* A group's limits hold for all groups in it: from this one up to the root. */
static void limits_up(const char *root, const char *group, struct cores_limits *limits)
{
	char folder[PATH_BYTES];
	if ((size_t)snprintf(folder, sizeof folder, "%s%s", root, group) >= sizeof folder)
		return;
	const size_t least = strlen(root);
	for (;;) {
		limits_of(folder, limits);
		char *slash = strrchr(folder, '/');
		if (!slash || (size_t)(slash - folder) < least)
			return;
		*slash = '\0';
	}
}

struct cores_limits cores_limits_read(const char *root, const char *groups)
{
	struct cores_limits limits = {INFINITY, INFINITY};
	char line[PATH_BYTES];
	FILE *file = fopen(groups, "re");

	limits_of(root, &limits); /* in a container its own group is the root that it sees */
	/* Lines "0::/GROUP" of version 2, "N:CONTROLLER,...:/GROUP" of version 1. */
	while (file && fgets(line, sizeof line, file)) {
		char *first = strchr(line, ':'), *second = first ? strchr(first + 1, ':') : NULL;
		if (!second)
			continue;
		*second++ = '\0';
		second[strcspn(second, "\n")] = '\0';
		if (!first[1]) {
			limits_up(root, second, &limits);
			continue;
		}
		for (char *rest = NULL, *controller = strtok_r(first + 1, ",", &rest); controller;
		     controller = strtok_r(NULL, ",", &rest))
			if (!strcmp(controller, "cpu") || !strcmp(controller, "memory")) {
				char mount[PATH_BYTES];
				if ((size_t)snprintf(mount, sizeof mount, "%s/%s", root, controller) < sizeof mount)
					limits_up(mount, second, &limits);
			}
	}
	if (file)
		fclose(file);
	return limits;
}

unsigned cores_allowed(unsigned cores, double machine_bytes, struct cores_limits limits)
{
	const double bytes = fmin(machine_bytes, limits.bytes);
	double most = fmin(cores, ceil(limits.cores - 1e-9));
	most = fmin(most, floor((bytes - BASE_BYTES) / WORKER_BYTES));
	return most < 1 ? 1 : most > WORKERS_MAX ? WORKERS_MAX : (unsigned)most;
}

unsigned cores_usable(void)
{
	cpu_set_t set;
	const unsigned cores = sched_getaffinity(0, sizeof set, &set) == 0 ? (unsigned)CPU_COUNT(&set) : 1;
	return cores_allowed(cores, (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE),
	                     cores_limits_read("/sys/fs/cgroup", "/proc/self/cgroup"));
}
