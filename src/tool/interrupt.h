/*
 * interrupt.h: Ctrl-C and SIGTERM as something to look at, so that whoever works can clean up.
 */
#ifndef TOOL_INTERRUPT_H
#define TOOL_INTERRUPT_H

#include <stdbool.h>

#include "brdfpack.h"

/* From now on SIGINT, SIGTERM and SIGHUP are noted. *wake_fd becomes readable with the first; NULL is allowed. */
bp_status interrupt_install(int *wake_fd, bp_error *error);

/* 0, or the signal that came. The tool then exits with 128 + this. */
int interrupt_signal(void);
bool interrupt_came(void);

/* Says that the signal kept `output` from being written; returns the exit code. */
int interrupt_exit(const char *output);

#endif
