/*
 * options.h: reading a command line the same way in every command: getopt_long, own messages,
 * strict numbers.
 *
 *     const struct option_rule rules[] = {{"output", 'o', option_text, .to = &output}, {"quiet", 'q', option_flag, .to = &quiet},
 *     {0}}; int code = options_read(self, argc, argv, rules);
 *     if (code != OPTIONS_END)
 *             return code;
 */
#ifndef TOOL_OPTIONS_H
#define TOOL_OPTIONS_H

#include <getopt.h>
#include <stdbool.h>
#include <stdint.h>

#include "command.h"
#include "model/fit.h"
#include "render/lights.h"

struct option_rule;

/* Takes what was written behind the option to rule->to; false after a usage message. */
typedef bool option_take_fn(const struct command *command, const struct option_rule *rule, const char *text);

/* One option of a command; --help and -h need none. */
struct option_rule {
	const char *name; /* without the "--"; NULL ends a list of them */
	char letter;      /* 0: it has none */
	option_take_fn *take;
	void *to;           /* what it fills; as it is where the option is not given */
	double least, most; /* of a number; whole ones below 2^53 */
};

option_take_fn option_flag;    /* bool: true; the only one that has no value */
option_take_fn option_text;    /* const char *: within argv */
option_take_fn option_output;  /* the same of -o, which the command cannot do without; its usage has an example */
option_take_fn option_integer; /* uint32_t; the whole text must be a number in [least, most], from 0 to 2^32 - 1 */
option_take_fn option_bytes;   /* int64_t; may end in k, M (1000) or Ki, Mi (1024), with or without a B */
option_take_fn option_number;  /* double */
option_take_fn option_light;   /* enum lighting */
option_take_fn option_profile; /* enum profile */

/*
 * Reads all options. OPTIONS_END: operands start at argv[optind]. Else an exit code: EXIT_OK after --help, EXIT_USAGE after a
 * message. A '-' for a file is refused: archives and measured files are read and written where one can seek.
 */
enum { OPTIONS_END = -1 };
int options_read(const struct command *command, int argc, char **argv, const struct option_rule *rules);

/*
 * Checks what -o names, a picture: it ends in .png or in `other`, and *is_other tells which; otherwise a usage message and
 * false. NULL: no -o was given.
 */
bool option_picture(const struct command *command, const char *output, const char *other, bool *is_other);

/* Whether a path has this ending, and something before it. */
bool text_ends_with(const char *text, const char *end);

#endif
