#include "tool/command.h"
#include "tool/interrupt.h"
#include "tool/options.h"
#include "tool/output_check.h"
#include "tool/report.h"

#include "archive/merge.h"
#include "error.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

/* All inputs stay open: asks for so many files where the usual limit (1,024) is lower. Opening tells where it is not allowed. */
static void files_allow(size_t count)
{
	struct rlimit limit;
	const rlim_t wanted = count + 32;
	if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < wanted) {
		limit.rlim_cur = limit.rlim_max < wanted ? limit.rlim_max : wanted;
		setrlimit(RLIMIT_NOFILE, &limit);
	}
}

static int merge_write(bp_archive **archives, char **paths, size_t count, const struct copy_options *options, bool quiet)
{
	struct copy_totals totals = {0};
	size_t failed = 0;
	bp_error error;

	if (interrupt_install(NULL, &error) ||
	    archive_merge((const struct bp_archive *const *)archives, count, options, &totals, &failed, &error))
		return report_error(totals.reading ? paths[failed] : options->output, totals.damaged[0] ? totals.damaged : NULL, &error);
	if (totals.stopped)
		return interrupt_exit(options->output);
	if (!quiet) {
		report_remark(options->output, &error);
		text_print(options->output, 0);
		printf(": %" PRIu64 " material%s", totals.copied, totals.copied == 1 ? "" : "s");
		if (totals.replaced > 0)
			printf(", %" PRIu64 " replaced by a later archive's", totals.replaced);
		putchar('\n');
	}
	return EXIT_OK;
}

static int merge_main(const struct command *self, int argc, char **argv)
{
	struct copy_options options = {.stop = interrupt_came};
	bool quiet = false, force = false;
	bp_error error;
	const struct option_rule rules[] = {{"output", 'o', option_output, .to = &options.output},
	                                    {"quiet", 'q', option_flag, .to = &quiet},
	                                    {"replace", 0, option_flag, .to = &options.replace},
	                                    {"expect", 0, option_integer, &options.shards, 1, 65536},
	                                    {"force", 0, option_flag, .to = &force},
	                                    {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	if (optind >= argc)
		return report_usage(self, "no archive");

	const size_t count = (size_t)(argc - optind);
	if (options.shards && options.shards != count)
		return report_text("%s: not written: %" PRIu32 " shards are expected, %zu archive%s given", options.output,
		                   options.shards, count, count == 1 ? " is" : "s are");
	if (!output_check(options.output, OUTPUT_KIND_ARCHIVE, force, (const char *const *)argv + optind, count))
		return EXIT_FAILED;
	files_allow(count);
	bp_archive **archives = calloc(count, sizeof *archives);
	if (!archives) {
		error_memory(&error, count * sizeof *archives);
		return report_error(NULL, NULL, &error);
	}
	size_t opened = 0;
	code = EXIT_FAILED;
	while (opened < count && !bp_archive_open(argv[optind + (int)opened], &archives[opened], &error))
		opened++;
	if (opened < count)
		report_error(argv[optind + (int)opened], NULL, &error);
	else
		code = merge_write(archives, argv + optind, count, &options, quiet);
	for (size_t n = 0; n < opened; n++)
		bp_archive_close(archives[n]);
	free(archives);
	return code;
}

const struct command command_merge = {
	.name = "merge",
	.run = merge_main,
	.description = "join archives, without re-encoding",
	.usage = "Usage: brdfpack merge -o OUT.bpk [OPTION]... ARCHIVE...\n"
			 "Joins archives; records are copied byte for byte. A name that stands in two of them is\n"
			 "refused, and nothing is written.\n"
			 "\n"
			 "  -o, --output OUT.bpk  the new archive; replaces an older one that is none of the inputs\n"
			 "      --force           also one of the inputs, or a file that is no archive\n"
			 "      --expect N        the archives are the N shards of one build (build --shard): refuse\n"
			 "                        another number, an archive that is no shard of N or is there twice,\n"
			 "                        and records made with other options or versions\n"
			 "      --replace         of a name that several archives have, take the last one's\n"
			 "  -q, --quiet           say nothing on success\n"
			 "  -h, --help            this text\n",
};
