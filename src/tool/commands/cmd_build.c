#include "tool/build/build.h"
#include "tool/command.h"
#include "tool/cores.h"
#include "tool/facts.h"
#include "tool/options.h"
#include "tool/report.h"
#include "tool/workers.h"

#include "codec/record.h"

#include <iconv.h>
#include <stdlib.h>

enum { SHARDS_MOST = 65536 };

/* "K/N" */
static bool shard_take(const struct command *self, const struct option_rule *rule, const char *text)
{
	struct build_options *options = rule->to;
	unsigned long k = 0, n = 0;
	char *end;
	if (*text >= '0' && *text <= '9') {
		k = strtoul(text, &end, 10);
		if (*end == '/' && end[1] >= '0' && end[1] <= '9')
			n = strtoul(end + 1, &end, 10);
	}
	options->shard = (unsigned)k;
	options->shard_count = (unsigned)n;
	if (n > 0 && !*end && k >= 1 && k <= n && n <= SHARDS_MOST)
		return true;
	report_usage(self, "--shard: '%s' is not K/N with 1 <= K <= N <= %d, as in 3/16", text, SHARDS_MOST);
	return false;
}

static bool charset_take(const struct command *self, const struct option_rule *rule, const char *text)
{
	const iconv_t conversion = iconv_open("UTF-8", text);
	*(const char **)rule->to = text;
	if (conversion != (iconv_t)-1)
		return iconv_close(conversion) == 0;
	report_usage(self, "--charset: no character set is called '%s'; `iconv -l` lists them", text);
	return false;
}

static bool zeros_take(const struct command *self, const struct option_rule *rule, const char *text)
{
	if (zeros_parse(text, rule->to))
		return true;
	report_usage(self, "--zeros: '%s' is neither 'auto' nor 'holes' nor 'measured'", text);
	return false;
}

static int build_main(const struct command *self, int argc, char **argv)
{
	struct build_options options = {
		.fit = {.profile = PROFILE_SPECTRAL},
		.workers = cores_usable(),
	};
	int64_t budget = 0;
	uint32_t effort = EFFORT_USUAL;
	const struct option_rule rules[] = {
		{"output", 'o', option_output, .to = &options.output},
		{"jobs", 'j', option_integer, &options.workers, 1, WORKERS_MAX},
		{"quiet", 'q', option_flag, .to = &options.quiet},
		{"profile", 0, option_profile, .to = &options.fit.profile},
		{"budget", 0, option_bytes, &budget, RECORD_BUDGET_MIN, RECORD_BUDGET_MAX},
		{"max-error", 0, option_number, &options.fit.max_error, 1e-6, 10},
		{"effort", 0, option_integer, &effort, 1, 9},
		{"manifest", 0, option_text, .to = &options.manifest},
		{"strict", 0, option_flag, .to = &options.strict},
		{"update", 0, option_flag, .to = &options.update},
		{"json", 0, option_flag, .to = &options.json},
		{"force", 0, option_flag, .to = &options.force},
		{"charset", 0, charset_take, .to = &options.charset},
		{"shard", 0, shard_take, .to = &options},
		{"any-lattice", 0, option_flag, .to = &options.any_lattice},
		{"zeros", 0, zeros_take, .to = &options.fit.zeros},
		{0},
	};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	if (optind >= argc)
		return report_usage(self, "no input; give measured files, folders, tar or zip files");
	if (budget && options.fit.max_error > 0)
		return report_usage(self, "--budget and --max-error exclude each other");
	options.fit.budget_bytes = options.fit.max_error > 0 ? RECORD_BUDGET_MAX : budget ? (uint32_t)budget : BUDGET_USUAL;
	options.fit.effort = (int)effort;
	options.inputs = argv + optind;
	options.input_count = argc - optind;
	return build_run(&options);
}

const struct command command_build = {
	.name = "build",
	.run = build_main,
	.description = "pack measured materials into an archive",
	.usage = "Usage: brdfpack build -o OUT.bpk [OPTION]... INPUT...\n"
			 "Packs measured materials into an archive. INPUT is a MERL file, a .bsdf of the RGL\n"
			 "database, a folder (searched to the bottom), or a tar or zip, plain or compressed. A\n"
			 "material's name is its file's stem. `man brdfpack` says what becomes of a .bsdf.\n"
			 "\n"
			 "  -o, --output OUT.bpk   the archive; an older one is replaced only by a whole one\n"
			 "      --force            replace what is there also when it is an input, or no archive\n"
			 "  -j, --jobs N           worker processes (1 to 256; default: the usable cores);\n"
			 "                         the archive's bytes do not depend on it\n"
			 "      --profile NAME     'spectral' (unless told otherwise), or 'paper': the paper's method\n"
			 "      --budget BYTES     largest record of a material (1000 to 4000000; default 60400);\n"
			 "                         BYTES may end in k, M, KiB or MiB\n"
			 "      --max-error E      instead: the smallest record whose log RMSE over all measured cells\n"
			 "                         is at most E\n"
			 "      --effort N         1 (fast) to 9 (small); default 5\n"
			 "      --zeros RULE       where no value is negative, zeros below the horizon are holes (auto); so is\n"
			 "                         every cell that is 0 in all channels (holes); or none is (measured)\n"
			 "      --manifest FILE    only the listed materials; where the list has sizes and SHA-256,\n"
			 "                         a file that differs is refused\n"
			 "      --charset NAME     the character set of names in tars and zips that are not UTF-8\n"
			 "                         (CP437, SHIFT_JIS, ISO-8859-1 ...)\n"
			 "      --strict           write no archive when a material is refused or missing\n"
			 "      --update           take the records of unchanged files (the same SHA-256, options and\n"
			 "                         codec) from the OUT.bpk that is there, and from what an interrupted\n"
			 "                         build had finished; what the inputs no longer hold is dropped\n"
			 "      --shard K/N        only the K-th of N parts of the materials, chosen by their names: N builds\n"
			 "                         of the same inputs, on as many machines, then merge --expect N\n"
			 "      --json             one line per material and a summary line, on standard output\n"
			 "  -q, --quiet            no progress bar and no warnings\n"
			 "      --any-lattice      accept files of other extents than MERL's 90 90 180 (for tests)\n"
			 "  -h, --help             this text\n"
			 "\n"
			 "What cannot be packed is named with the reason, the others are packed, and the exit code is 1.\n",
};
