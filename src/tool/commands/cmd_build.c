#include "tool/build/build.h"
#include "tool/command.h"
#include "tool/cores.h"
#include "tool/facts.h"
#include "tool/options.h"
#include "tool/report.h"

#include "codec/record.h"

#include <iconv.h>
#include <stdlib.h>

enum {
	OPTION_PROFILE = OPTION_LONG,
	OPTION_BUDGET,
	OPTION_MAX_ERROR,
	OPTION_EFFORT,
	OPTION_MANIFEST,
	OPTION_STRICT,
	OPTION_UPDATE,
	OPTION_JSON,
	OPTION_ANY_LATTICE,
	OPTION_SHARD,
	OPTION_FORCE,
	OPTION_CHARSET,
	OPTION_ZEROS
};

enum { SHARDS_MOST = 65536 };

/* "K/N" */
static bool shard_parse(const char *text, struct build_options *options)
{
	char *end;
	if (*text < '0' || *text > '9')
		return false;
	const unsigned long k = strtoul(text, &end, 10);
	if (*end != '/' || end[1] < '0' || end[1] > '9')
		return false;
	const unsigned long n = strtoul(end + 1, &end, 10);
	options->shard = (unsigned)k;
	options->shard_count = (unsigned)n;
	return !*end && k >= 1 && k <= n && n <= SHARDS_MOST;
}

static bool charset_known(const char *name)
{
	const iconv_t conversion = iconv_open("UTF-8", name);
	if (conversion == (iconv_t)-1)
		return false;
	iconv_close(conversion);
	return true;
}

static int build_main(const struct command *self, int argc, char **argv)
{
	static const struct option names[] = {
		{"output", required_argument, NULL, 'o'},
		{"jobs", required_argument, NULL, 'j'},
		{"quiet", no_argument, NULL, 'q'},
		{"profile", required_argument, NULL, OPTION_PROFILE},
		{"budget", required_argument, NULL, OPTION_BUDGET},
		{"max-error", required_argument, NULL, OPTION_MAX_ERROR},
		{"effort", required_argument, NULL, OPTION_EFFORT},
		{"manifest", required_argument, NULL, OPTION_MANIFEST},
		{"strict", no_argument, NULL, OPTION_STRICT},
		{"update", no_argument, NULL, OPTION_UPDATE},
		{"json", no_argument, NULL, OPTION_JSON},
		{"force", no_argument, NULL, OPTION_FORCE},
		{"charset", required_argument, NULL, OPTION_CHARSET},
		{"shard", required_argument, NULL, OPTION_SHARD},
		{"any-lattice", no_argument, NULL, OPTION_ANY_LATTICE},
		{"zeros", required_argument, NULL, OPTION_ZEROS},
		{0},
	};
	struct build_options options = {
		.fit = {.profile = PROFILE_SPECTRAL, .budget_bytes = BUDGET_USUAL, .effort = EFFORT_USUAL},
		.workers = cores_usable(),
	};
	bool has_budget = false;
	int64_t number;
	int option;

	while ((option = options_next(self, argc, argv, "o:j:q", names)) >= 0) {
		switch (option) {
		case 'o': options.output = optarg; break;
		case 'q': options.quiet = true; break;
		case OPTION_MANIFEST: options.manifest = optarg; break;
		case OPTION_STRICT: options.strict = true; break;
		case OPTION_UPDATE: options.update = true; break;
		case OPTION_FORCE: options.force = true; break;
		case OPTION_CHARSET:
			if (!charset_known(optarg))
				return report_usage(self, "--charset: no character set is called '%s'; `iconv -l` lists them", optarg);
			options.charset = optarg;
			break;
		case OPTION_JSON: options.json = true; break;
		case OPTION_ANY_LATTICE: options.any_lattice = true; break;
		case 'j':
			if (!option_jobs(self, optarg, &options.workers))
				return EXIT_USAGE;
			break;
		case OPTION_PROFILE:
			if (!option_profile(self, optarg, &options.fit.profile))
				return EXIT_USAGE;
			break;
		case OPTION_ZEROS:
			if (!zeros_parse(optarg, &options.fit.zeros))
				return report_usage(self, "--zeros: '%s' is neither 'auto' nor 'holes' nor 'measured'", optarg);
			break;
		case OPTION_BUDGET:
			if (!option_bytes(self, "--budget", optarg, RECORD_BUDGET_MIN, RECORD_BUDGET_MAX, &number))
				return EXIT_USAGE;
			options.fit.budget_bytes = (uint32_t)number;
			has_budget = true;
			break;
		case OPTION_MAX_ERROR:
			if (!option_number(self, "--max-error", optarg, 1e-6, 10, &options.fit.max_error))
				return EXIT_USAGE;
			break;
		case OPTION_SHARD:
			if (!shard_parse(optarg, &options))
				return report_usage(self, "--shard: '%s' is not K/N with 1 <= K <= N <= %d, as in 3/16", optarg, SHARDS_MOST);
			break;
		case OPTION_EFFORT:
			if (!option_integer(self, "--effort", optarg, 1, 9, &number))
				return EXIT_USAGE;
			options.fit.effort = (int)number;
			break;
		}
	}
	if (option != OPTIONS_END)
		return options_exit_code(option);
	if (!option_output(self, options.output, "OUT.bpk"))
		return EXIT_USAGE;
	if (optind >= argc)
		return report_usage(self, "no input; give measured files, folders, tar or zip files");
	if (has_budget && options.fit.max_error > 0)
		return report_usage(self, "--budget and --max-error exclude each other");
	if (options.fit.max_error > 0)
		options.fit.budget_bytes = RECORD_BUDGET_MAX;
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
			 "      --max-error E      instead: the smallest record whose log RMSE is at most E\n"
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
