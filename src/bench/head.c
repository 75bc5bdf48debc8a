#include "head.h"

#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

/* As the system calls it; "unknown" where it does not say. */
static void processor_name(char *out, size_t capacity)
{
	char line[512];
	FILE *file = fopen("/proc/cpuinfo", "r");

	snprintf(out, capacity, "unknown");
	while (file && fgets(line, sizeof line, file))
		if (!strncmp(line, "model name", 10) && strchr(line, ':')) {
			snprintf(out, capacity, "%s", strchr(line, ':') + 2);
			out[strcspn(out, "\n")] = 0;
			break;
		}
	if (file)
		fclose(file);
}

void head_print(FILE *out, int argc, char **argv)
{
	char processor[256], date[64];
	struct utsname system;
	time_t now = time(NULL);
	const char *commit = getenv("BENCH_COMMIT");

	processor_name(processor, sizeof processor);
	uname(&system);
	strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", gmtime(&now));
	fprintf(out, "# brdfpack-bench, %s\n", date);
	fprintf(out, "# machine: %s, %ld usable cores, %s %s %s\n", processor, sysconf(_SC_NPROCESSORS_ONLN), system.sysname,
	        system.release, system.machine);
	fprintf(out, "# compiler: %s %s\n",
#ifdef __clang__
	        "clang", __clang_version__);
#else
	        "gcc", __VERSION__);
#endif
	fprintf(out, "# commit: %s\n", commit && *commit ? commit : "unknown");
	fprintf(out, "# command:");
	for (int n = 0; n < argc; n++)
		fprintf(out, strchr(argv[n], ' ') ? " \"%s\"" : " %s", argv[n]);
	fputc('\n', out);
}
