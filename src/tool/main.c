/*
 * main.c: the table of subcommands, and what they share: standard streams that can be
 * trusted, help, the version, and the exit code.
 */
#include "command.h"
#include "report.h"
#include "usage.h"

#include "brdfpack.h"
#include "merl/spelling.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* A new command is one cmd_NAME.c and one line here, in the order `help` shows them. */
#define COMMANDS(X) \
	X(build) \
	X(list) \
	X(extract) \
	X(verify) \
	X(subset) \
	X(merge) \
	X(recover) \
	X(synth) \
	X(render) \
	X(compare) \
	X(show) \
	X(report)

#define DECLARE(name) extern const struct command command_##name;
COMMANDS(DECLARE)

#define POINTER(name) &command_##name,
static const struct command *const commands[] = {COMMANDS(POINTER) NULL};

static const struct command *command_find(const char *name)
{
	for (size_t i = 0; commands[i]; i++)
		if (!strcmp(commands[i]->name, name))
			return commands[i];
	return NULL;
}

static void command_unknown(const char *name)
{
	struct name_guess guess;
	name_guess_start(&guess, name);
	for (size_t i = 0; commands[i]; i++)
		name_guess_offer(&guess, commands[i]->name);
	const char *best = name_guess_best(&guess);
	report_text("unknown command '%s'%s%s%s; `brdfpack help` lists the commands", name, best ? " (did you mean '" : "",
	            best ? best : "", best ? "'?)" : "");
}

static void help_print(FILE *out)
{
	fprintf(out, "brdfpack packs measured materials (MERL and RGL files) into one indexed archive.\n\n"
	             "Usage: brdfpack COMMAND [OPTION]... [ARGUMENT]...\n\nCommands:\n");
	for (size_t i = 0; commands[i]; i++)
		fprintf(out, "  %-9s %s\n", commands[i]->name, commands[i]->description);
	fprintf(out, "\n`brdfpack COMMAND --help` explains a command, `brdfpack --version` the version.\n"
	             "Exit codes: 0 done, 1 something failed, 2 the command line is wrong.\n");
}

/*
 * Makes sure that descriptors 0 to 2 are taken: otherwise the first file opened would become
 * standard output, and messages would be written into it. A closed standard output becomes one
 * that refuses to be written to, so that output is never lost without an error.
 */
static void streams_secure(void)
{
	for (int fd = 0; fd <= 2; fd++)
		if (fcntl(fd, F_GETFD) < 0 && errno == EBADF)
			(void)!open("/dev/null", fd == 2 ? O_WRONLY : O_RDONLY);
}

static int run(int argc, char **argv)
{
	if (argc < 2) {
		help_print(stderr);
		return EXIT_USAGE;
	}
	const char *name = argv[1];
	if (!strcmp(name, "--version") || !strcmp(name, "-V")) {
		printf("brdfpack %s\n", BP_VERSION);
		return EXIT_OK;
	}
	bool wants_help = !strcmp(name, "--help") || !strcmp(name, "-h") || !strcmp(name, "help");
	if (wants_help && (argc < 3 || !strcmp(argv[2], "help") || !strcmp(argv[2], "--help") || !strcmp(argv[2], "-h"))) {
		help_print(stdout);
		return EXIT_OK;
	}
	const struct command *command = command_find(wants_help ? argv[2] : name);
	if (!command) {
		command_unknown(wants_help ? argv[2] : name);
		return EXIT_USAGE;
	}
	if (wants_help) {
		usage_print(stdout, command->usage);
		return EXIT_OK;
	}
	return command->run(command, argc - 1, argv + 1);
}

int main(int argc, char **argv)
{
	streams_secure();
	signal(SIGPIPE, SIG_IGN); /* a closed pipe shows as a failed write, below */
	signal(SIGXFSZ, SIG_IGN); /* and so does a file that grows beyond the limit (ulimit -f): "File too large" */
	int code = run(argc, argv);
	if (fflush(stdout) != 0 || ferror(stdout)) {
		if (errno != EPIPE) /* whoever closed the pipe wants to hear no more */
			report_text("standard output: %s", strerror(errno));
		if (code == EXIT_OK)
			code = EXIT_FAILED;
	}
	return code;
}
