#include "options.h"

#include "facts.h"
#include "report.h"
#include "usage.h"
#include "workers.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_HELP = 255, NAMES_MAX = 32 };

/* Behind "--" a '-' is a name like any other: of a material, it may be. */
static bool operands_check(const struct command *command, int argc, char **argv)
{
	if (optind > 1 && !strcmp(argv[optind - 1], "--"))
		return true;
	for (int n = optind; n < argc; n++)
		if (!strcmp(argv[n], "-")) {
			report_usage(command,
			             "'-': standard input cannot be read, give a file's name ('./-' is a file called so; '-- -' a material)");
			return false;
		}
	return true;
}

int options_next(const struct command *command, int argc, char **argv, const char *letters, const struct option *names)
{
	char all_letters[64];
	struct option all_names[NAMES_MAX + 2] = {{"help", no_argument, NULL, OPTION_HELP}};

	snprintf(all_letters, sizeof all_letters, ":h%s", letters); /* ':': a missing argument is told apart */
	for (int i = 0; i < NAMES_MAX && names[i].name; i++)
		all_names[i + 1] = names[i];
	opterr = 0;
	const char *word = optind < argc ? argv[optind] : ""; /* for messages; permuting moves only operands before it */
	int index = -1;
	int option = getopt_long(argc, argv, all_letters, all_names, &index);
	if (optind > 0 && optind <= argc && option != -1)
		word = argv[optind - 1];
	if (index >= 0 && option != '?' && option != ':') {
		/* getopt takes any beginning of a name that is no other's: a script that relies on one breaks when an option is added. */
		const char *written = optarg && optarg == word ? argv[optind - 2] : word, *whole = all_names[index].name;
		if (strcspn(written + 2, "=") != strlen(whole)) {
			report_usage(command, "unknown option '%.*s' (did you mean '--%s'?)", (int)strcspn(written, "="), written, whole);
			return OPTIONS_WRONG;
		}
	}
	if (option >= 0 && option != '?' && option != ':' && optarg && !strcmp(optarg, "-")) {
		report_usage(command,
		             "'-' after '%s%s': standard input and output cannot be had, give a file's name ('./-' is a file called so)",
		             index >= 0 ? "--" : "", index >= 0 ? all_names[index].name : (const char[]){'-', (char)option, '\0'});
		return OPTIONS_WRONG;
	}
	switch (option) {
	case -1: return operands_check(command, argc, argv) ? OPTIONS_END : OPTIONS_WRONG;
	case OPTION_HELP:
	case 'h': usage_print(stdout, command->usage); return OPTIONS_HELPED;
	case ':': report_usage(command, "option '%s' needs a value", word); return OPTIONS_WRONG;
	case '?':
		if (!strncmp(word, "--", 2) && strchr(word, '=') && optopt)
			report_usage(command, "option '%.*s' takes no value", (int)strcspn(word, "="), word);
		else if (optopt && optopt < 128 && isprint(optopt) && strncmp(word, "--", 2) != 0)
			report_usage(command, "unknown option '-%c'", optopt);
		else
			report_usage(command, "unknown option '%s'", word);
		return OPTIONS_WRONG;
	default: return option;
	}
}

int options_exit_code(int option) { return option == OPTIONS_HELPED ? EXIT_OK : EXIT_USAGE; }

static bool range_refuse(const struct command *command, const char *option, const char *text, int64_t least, int64_t most)
{
	report_usage(command, "%s: '%s' is not a whole number from %" PRId64 " to %" PRId64, option, text, least, most);
	return false;
}

/* The digits at the start of text; *rest is what follows. False without a digit, or on overflow. */
static bool digits_parse(const char *text, int64_t *out, const char **rest)
{
	char *end;
	if (!isdigit((unsigned char)text[0]))
		return false; /* strtoll alone would skip spaces and take a sign */
	errno = 0;
	long long value = strtoll(text, &end, 10);
	*out = value;
	*rest = end;
	return errno == 0;
}

bool option_integer(const struct command *command, const char *option, const char *text, int64_t least, int64_t most,
                    int64_t *out)
{
	int64_t value;
	const char *rest;
	if (!digits_parse(text, &value, &rest) || *rest || value < least || value > most)
		return range_refuse(command, option, text, least, most);
	*out = value;
	return true;
}

bool option_bytes(const struct command *command, const char *option, const char *text, int64_t least, int64_t most, int64_t *out)
{
	static const struct {
		const char *suffix;
		int64_t factor;
	} units[] = {{"", 1},      {"B", 1},      {"k", 1000},    {"kB", 1000},    {"K", 1000},     {"KB", 1000},
	             {"Ki", 1024}, {"KiB", 1024}, {"M", 1000000}, {"MB", 1000000}, {"Mi", 1048576}, {"MiB", 1048576}};
	int64_t value;
	const char *rest;
	if (!digits_parse(text, &value, &rest))
		return range_refuse(command, option, text, least, most);
	for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
		int64_t bytes;
		if (strcmp(rest, units[i].suffix) != 0)
			continue;
		if (__builtin_mul_overflow(value, units[i].factor, &bytes) || bytes < least || bytes > most)
			break;
		*out = bytes;
		return true;
	}
	return range_refuse(command, option, text, least, most);
}

bool option_number(const struct command *command, const char *option, const char *text, double least, double most, double *out)
{
	char *end = NULL;
	bool starts_well = isdigit((unsigned char)text[0]) || text[0] == '.';
	double value = starts_well ? strtod(text, &end) : NAN;
	if (!starts_well || *end || !(value >= least && value <= most)) {
		report_usage(command, "%s: '%s' is not a number from %g to %g", option, text, least, most);
		return false;
	}
	*out = value;
	return true;
}

bool option_jobs(const struct command *command, const char *text, unsigned *workers)
{
	int64_t count;
	if (!option_integer(command, "-j", text, 1, WORKERS_MAX, &count))
		return false;
	*workers = (unsigned)count;
	return true;
}

bool option_light(const struct command *command, const char *text, enum lighting *lighting)
{
	if (lighting_find(text, lighting))
		return true;
	report_usage(command, "--light: '%s' is none of key, env and point", text);
	return false;
}

bool option_profile(const struct command *command, const char *text, enum profile *profile)
{
	if (profile_parse(text, profile))
		return true;
	report_usage(command, "--profile: '%s' is neither spectral nor paper", text);
	return false;
}

bool option_output(const struct command *command, const char *output, const char *example)
{
	if (output && *output)
		return true;
	report_usage(command, "no output file; give one with -o %s", example);
	return false;
}

bool option_picture(const struct command *command, const char *output, const char *other, bool *is_other)
{
	*is_other = output && text_ends_with(output, other);
	if (!output)
		report_usage(command, "no output (-o OUT.png or OUT%s)", other);
	else if (!*is_other && !text_ends_with(output, ".png"))
		report_usage(command, "'%s' ends in neither .png nor %s", output, other);
	else
		return true;
	return false;
}

bool text_ends_with(const char *text, const char *end)
{
	size_t text_bytes = strlen(text), end_bytes = strlen(end);
	return text_bytes > end_bytes && !strcmp(text + text_bytes - end_bytes, end);
}
