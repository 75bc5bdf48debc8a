#include "interrupt.h"

#include "error.h"
#include "report.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

static volatile sig_atomic_t noted;
static int wake_pipe[2] = {-1, -1};

static void note(int number)
{
	int kept = errno;
	if (!noted)
		noted = number;
	(void)!write(wake_pipe[1], "", 1); /* never blocks; when the pipe is full it is readable anyway */
	errno = kept;
}

bp_status interrupt_install(int *wake_fd, bp_error *error)
{
	static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
	if (pipe2(wake_pipe, O_CLOEXEC | O_NONBLOCK) != 0)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot create a pipe: %s", strerror(errno));
	for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
		struct sigaction action = {.sa_handler = note, .sa_flags = SA_RESTART};
		struct sigaction old;
		sigemptyset(&action.sa_mask);
		/* A command started in the background, or by nohup, ignores some of them: that stays. */
		if (sigaction(numbers[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN)
			sigaction(numbers[i], &action, NULL);
	}
	if (wake_fd)
		*wake_fd = wake_pipe[0];
	return BP_OK;
}

int interrupt_signal(void) { return noted; }

bool interrupt_came(void) { return interrupt_signal() != 0; }

int interrupt_exit(const char *output)
{
	report_text("%s: interrupted; not written", output);
	return 128 + interrupt_signal();
}
