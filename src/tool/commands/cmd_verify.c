#include "tool/command.h"
#include "tool/json.h"
#include "tool/options.h"
#include "tool/report.h"

#include "brdfpack.h"

#include <inttypes.h>
#include <stdio.h>

struct findings {
	const char *path;
	bool json;
	uint64_t count;
};

static int problem_report(void *user, const bp_problem *problem)
{
	struct findings *findings = user;
	findings->count++;
	if (findings->json) {
		char text[1024];
		struct json json = json_begin(stdout, false);
		error_describe(&problem->error, text, sizeof text);
		if (problem->material)
			json_string(&json, "name", problem->material);
		if (problem->error.offset != BP_NO_OFFSET)
			json_integer(&json, "offset", problem->error.offset);
		json_string(&json, "error", text);
		json_finish(&json);
	} else {
		report_error(findings->path, problem->material, &problem->error);
	}
	return 0;
}

static void summary_print(const struct findings *findings, uint64_t materials, uint64_t bytes, bool deep)
{
	if (findings->json) {
		struct json json = json_begin(stdout, false);
		json_bool(&json, "summary", true);
		json_string(&json, "archive", findings->path);
		json_bool(&json, "deep", deep);
		json_integer(&json, "materials", materials);
		json_integer(&json, "bytes_read", bytes);
		json_integer(&json, "problems", findings->count);
		json_finish(&json);
	} else if (findings->count == 0) {
		text_print(findings->path, 0);
		printf(": %" PRIu64 " material%s%s, no problem found\n", materials, materials == 1 ? "" : "s",
		       deep ? ", all decoded" : "");
	} else {
		text_print(findings->path, 0);
		printf(": %" PRIu64 " problem%s found; restore a copy, build it again, or save the rest with `brdfpack recover`\n",
		       findings->count, findings->count == 1 ? "" : "s");
	}
}

static int verify_main(const struct command *self, int argc, char **argv)
{
	struct findings findings = {0};
	bp_archive *archive = NULL;
	bool deep = false;
	bp_error error;
	const struct option_rule rules[] = {
		{"deep", 0, option_flag, .to = &deep}, {"json", 0, option_flag, .to = &findings.json}, {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	if (argc - optind != 1)
		return report_usage(self, argc == optind ? "no archive" : "more than one archive");
	findings.path = argv[optind];
	uint64_t materials = 0, bytes = 0;
	bp_status status = bp_archive_open(findings.path, &archive, &error);
	if (!status) {
		status = bp_archive_verify(archive, deep ? BP_VERIFY_DEEP : 0, problem_report, &findings, &error);
		materials = bp_archive_count(archive);
		bytes = bp_archive_bytes_read(archive);
	}
	bool opened = archive != NULL;
	if (status && findings.count == 0) { /* it could not even begin */
		const bp_problem problem = {NULL, error};
		problem_report(&findings, &problem);
	}
	if (opened || findings.json)
		summary_print(&findings, materials, bytes, deep);
	bp_archive_close(archive);
	return status ? EXIT_FAILED : EXIT_OK;
}

const struct command command_verify = {
	.name = "verify",
	.run = verify_main,
	.description = "check every byte of an archive",
	.usage = "Usage: brdfpack verify [--deep] [--json] ARCHIVE\n"
			 "Reads the whole archive and checks all checksums, the index and the order of the names.\n"
			 "\n"
			 "      --deep   also decodes every layer of every material and checks its values\n"
			 "      --json   one JSON object per problem, then a summary object\n"
			 "  -h, --help   this text\n",
};
