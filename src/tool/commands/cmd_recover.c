#include "tool/command.h"
#include "tool/options.h"
#include "tool/output_check.h"
#include "tool/report.h"

#include "archive/recover.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>

static void loss_report(void *user, const char *material, const bp_error *why) { report_error(user, material, why); }

static int recover_main(const struct command *self, int argc, char **argv)
{
	const char *output = NULL;
	struct recovery recovery = {0};
	bool force = false;
	bp_error error;
	const struct option_rule rules[] = {
		{"output", 'o', option_output, .to = &output}, {"force", 0, option_flag, .to = &force}, {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	if (argc - optind != 1)
		return report_usage(self, argc == optind ? "no archive" : "more than one archive");
	if (!output_check(output, OUTPUT_KIND_ARCHIVE, force, (const char *const *)argv + optind, 1))
		return EXIT_FAILED;
	if (archive_recover(argv[optind], output, loss_report, argv[optind], &recovery, &error) != BP_OK) {
		/* what cannot be read or written names itself; what is no archive, here */
		return report_error(error.status == BP_ERROR_NOT_OURS ? argv[optind] : NULL, NULL, &error);
	}
	report_remark(output, &error);
	text_print(output, 0);
	printf(": %" PRIu64 " saved, %" PRIu64 " lost\n", recovery.saved, recovery.lost);
	return recovery.lost ? EXIT_FAILED : EXIT_OK;
}

const struct command command_recover = {
	.name = "recover",
	.run = recover_main,
	.description = "save what is intact in a damaged archive",
	.usage = "Usage: brdfpack recover -o OUT.bpk DAMAGED.bpk\n"
			 "Scans the damaged archive for records, with or without its index, and writes every record whose\n"
			 "checksums hold into a new archive, unchanged. Says what was lost, as far as a record's head or the\n"
			 "index tells, and how many more the header counts; exit code 1 when anything was.\n"
			 "\n"
			 "  -o, --output FILE  the new archive; replaces an older one, but not the damaged one\n"
			 "      --force        also the damaged one, or a file that is no archive\n"
			 "  -h, --help         this text\n",
};
