#include "options.h"

#include "facts.h"
#include "merl/spelling.h"
#include "report.h"
#include "usage.h"

#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RULES_MAX = 32, LONG = 256 }; /* a rule's number in getopt's words: LONG and its place */
enum { ENDED = -1, HELPED = -2, WRONG = -3 };

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

static void option_unknown(const struct command *command, const char *word, const struct option *names)
{
	char written[SPELLING_BYTES_MAX + 1];
	struct name_guess guess;
	snprintf(written, sizeof written, "%.*s", (int)strcspn(word, "="), word);
	name_guess_start(&guess, written + strspn(written, "-"));
	for (; names->name; names++)
		name_guess_offer(&guess, names->name);
	const char *best = name_guess_best(&guess);
	report_usage(command, "unknown option '%s'%s%s%s", written, best ? " (did you mean '--" : "", best ? best : "",
	             best ? "'?)" : "");
}

/* The next option's letter or number; ENDED, HELPED after the help, WRONG after a message. */
static int option_next(const struct command *command, int argc, char **argv, const char *letters, const struct option *names)
{
	opterr = 0;
	const char *word = optind < argc ? argv[optind] : ""; /* for messages; permuting moves only operands before it */
	int index = -1;
	int option = getopt_long(argc, argv, letters, names, &index);
	if (optind > 0 && optind <= argc && option != -1)
		word = argv[optind - 1];
	if (index >= 0 && option != '?' && option != ':') {
		/* getopt takes any beginning of a name that is no other's: a script that relies on one breaks when an option is added. */
		const char *written = optarg && optarg == word ? argv[optind - 2] : word, *whole = names[index].name;
		if (strcspn(written + 2, "=") != strlen(whole)) {
			report_usage(command, "unknown option '%.*s' (did you mean '--%s'?)", (int)strcspn(written, "="), written, whole);
			return WRONG;
		}
	}
	if (option >= 0 && option != '?' && option != ':' && optarg && !strcmp(optarg, "-")) {
		report_usage(command,
		             "'-' after '%s%s': standard input and output cannot be had, give a file's name ('./-' is a file called so)",
		             index >= 0 ? "--" : "", index >= 0 ? names[index].name : (const char[]){'-', (char)option, '\0'});
		return WRONG;
	}
	switch (option) {
	case -1: return operands_check(command, argc, argv) ? ENDED : WRONG;
	case 'h': usage_print(stdout, command->usage); return HELPED;
	case ':': report_usage(command, "option '%s' needs a value", word); return WRONG;
	case '?':
		if (!strncmp(word, "--", 2) && strchr(word, '=') && optopt)
			report_usage(command, "option '%.*s' takes no value", (int)strcspn(word, "="), word);
		else if (optopt && optopt < 128 && isprint(optopt) && strncmp(word, "--", 2) != 0)
			report_usage(command, "unknown option '-%c'", optopt);
		else
			option_unknown(command, word, names);
		return WRONG;
	default: return option;
	}
}

int options_read(const struct command *command, int argc, char **argv, const struct option_rule *rules)
{
	char letters[3 + 2 * RULES_MAX] = ":h"; /* ':': a missing argument is told apart */
	struct option names[RULES_MAX + 2] = {{"help", no_argument, NULL, 'h'}};
	int option;

	for (int n = 0; n < RULES_MAX && rules[n].name; n++) {
		const bool takes = rules[n].take != option_flag;
		names[n + 1] = (struct option){rules[n].name, takes ? required_argument : no_argument, NULL, LONG + n};
		if (rules[n].letter)
			strcat(letters, (const char[]){rules[n].letter, takes ? ':' : '\0', '\0'});
	}
	while ((option = option_next(command, argc, argv, letters, names)) >= 0) {
		const struct option_rule *rule = rules;
		while (option >= LONG ? rule != &rules[option - LONG] : rule->letter != option)
			rule++;
		if (!rule->take(command, rule, optarg))
			return EXIT_USAGE;
	}
	for (const struct option_rule *rule = rules; option == ENDED && rule->name; rule++)
		if (rule->take == option_output && !(*(const char **)rule->to && **(const char **)rule->to)) {
			const char *const example = strstr(command->usage, "-o ") + 3;
			return report_usage(command, "no output file; give one with -o %.*s", (int)strcspn(example, " "), example);
		}
	return option == ENDED ? OPTIONS_END : option == HELPED ? EXIT_OK : EXIT_USAGE;
}

bool option_flag(const struct command *command, const struct option_rule *rule, const char *text)
{
	(void)command, (void)text;
	*(bool *)rule->to = true;
	return true;
}

bool option_text(const struct command *command, const struct option_rule *rule, const char *text)
{
	(void)command;
	*(const char **)rule->to = text;
	return true;
}

bool option_output(const struct command *command, const struct option_rule *rule, const char *text)
{
	return option_text(command, rule, text);
}

static bool range_refuse(const struct command *command, const struct option_rule *rule, const char *text)
{
	const char letter[] = {'-', rule->letter, '\0'};
	report_usage(command, "%s%s: '%s' is not a whole number from %.0f to %.0f", rule->letter ? letter : "--",
	             rule->letter ? "" : rule->name, text, rule->least, rule->most);
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

bool option_integer(const struct command *command, const struct option_rule *rule, const char *text)
{
	int64_t value;
	const char *rest;
	if (!digits_parse(text, &value, &rest) || *rest || (double)value < rule->least || (double)value > rule->most)
		return range_refuse(command, rule, text);
	*(uint32_t *)rule->to = (uint32_t)value;
	return true;
}

bool option_bytes(const struct command *command, const struct option_rule *rule, const char *text)
{
	static const struct {
		const char *suffix;
		int64_t factor;
	} units[] = {{"", 1},      {"B", 1},      {"k", 1000},    {"kB", 1000},    {"K", 1000},     {"KB", 1000},
	             {"Ki", 1024}, {"KiB", 1024}, {"M", 1000000}, {"MB", 1000000}, {"Mi", 1048576}, {"MiB", 1048576}};
	int64_t value, bytes;
	const char *rest;
	for (size_t i = 0; digits_parse(text, &value, &rest) && i < sizeof units / sizeof units[0]; i++)
		if (!strcmp(rest, units[i].suffix) && !__builtin_mul_overflow(value, units[i].factor, &bytes) &&
		    (double)bytes >= rule->least && (double)bytes <= rule->most) {
			*(int64_t *)rule->to = bytes;
			return true;
		}
	return range_refuse(command, rule, text);
}

bool option_number(const struct command *command, const struct option_rule *rule, const char *text)
{
	char *end = NULL;
	bool starts_well = isdigit((unsigned char)text[0]) || text[0] == '.';
	double value = starts_well ? strtod(text, &end) : NAN;
	if (!starts_well || *end || !(value >= rule->least && value <= rule->most)) {
		report_usage(command, "--%s: '%s' is not a number from %g to %g", rule->name, text, rule->least, rule->most);
		return false;
	}
	*(double *)rule->to = value;
	return true;
}

bool option_light(const struct command *command, const struct option_rule *rule, const char *text)
{
	if (lighting_find(text, rule->to))
		return true;
	report_usage(command, "--light: '%s' is none of key, env and point", text);
	return false;
}

bool option_profile(const struct command *command, const struct option_rule *rule, const char *text)
{
	if (profile_parse(text, rule->to))
		return true;
	report_usage(command, "--profile: '%s' is neither spectral nor paper", text);
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
