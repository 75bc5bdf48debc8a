/*
 * options.h: reading a command line the same way in every command: getopt_long, own messages,
 * strict numbers.
 *
 *     int option;
 *     while ((option = options_next(self, argc, argv, "o:q", long_options)) >= 0)
 *             switch (option) { ... }
 *     if (option != OPTIONS_END)
 *             return options_exit_code(option);
 */
#ifndef TOOL_OPTIONS_H
#define TOOL_OPTIONS_H

#include <getopt.h>
#include <stdbool.h>
#include <stdint.h>

#include "command.h"
#include "model/fit.h"
#include "render/lights.h"

enum { OPTIONS_END = -1, OPTIONS_HELPED = -2, OPTIONS_WRONG = -3 };

/* Long options without a letter get values from here on. */
enum { OPTION_LONG = 256 };

/*
 * The next option's letter or value; OPTIONS_END after the last (operands start at argv[optind]);
 * OPTIONS_HELPED when --help or -h was given and has been printed; OPTIONS_WRONG after a message.
 * A '-' for a file is refused: archives and measured files are read and written where one can seek.
 * `letters` without a leading ':' or '+'; --help need not be listed.
 */
int options_next(const struct command *command, int argc, char **argv, const char *letters, const struct option *names);
int options_exit_code(int option);

/*
 * The whole text must be a number in [least, most]; otherwise a usage message names the option and
 * the range, and false is returned. Bytes may end in k, M (1000) or Ki, Mi (1024), with or without a B.
 */
bool option_integer(const struct command *command, const char *option, const char *text, int64_t least, int64_t most,
                    int64_t *out);
bool option_bytes(const struct command *command, const char *option, const char *text, int64_t least, int64_t most, int64_t *out);
bool option_number(const struct command *command, const char *option, const char *text, double least, double most, double *out);

/* The values of -j, --light and --profile; otherwise a usage message and false. */
bool option_jobs(const struct command *command, const char *text, unsigned *workers);
bool option_light(const struct command *command, const char *text, enum lighting *lighting);
bool option_profile(const struct command *command, const char *text, enum profile *profile);

/* Whether -o named a file; otherwise a usage message with `example` and false. */
bool option_output(const struct command *command, const char *output, const char *example);

/*
 * Checks what -o names, a picture: it ends in .png or in `other`, and *is_other tells which; otherwise a usage message and
 * false. NULL: no -o was given.
 */
bool option_picture(const struct command *command, const char *output, const char *other, bool *is_other);

/* Whether a path has this ending, and something before it. */
bool text_ends_with(const char *text, const char *end);

#endif
