/*
 * command.h: what a subcommand is. Each lives in its own cmd_NAME.c and exports
 * one `const struct command command_NAME`; main.c lists the names.
 */
#ifndef TOOL_COMMAND_H
#define TOOL_COMMAND_H

/* Exit codes of the tool, the same for every command. */
enum {
	EXIT_OK = 0,
	EXIT_FAILED = 1, /* something that was asked for could not be done; stderr says what */
	EXIT_USAGE = 2   /* the command line is wrong; nothing was done */
};

struct command {
	const char *name;
	int (*run)(const struct command *self, int argc, char **argv); /* argv[0] is the command's name; returns an exit code */
	const char *description;                                       /* one line for `brdfpack help` */
	const char *usage; /* what `brdfpack NAME --help` prints, from "Usage: brdfpack NAME ..." on */
};

#endif
