/*
 * report.h: messages to standard error, all of the form
 *
 *     brdfpack: FILE: MATERIAL: reason
 *
 * with the remedy after a semicolon where one is known. Control characters in names and
 * paths are shown as \xNN, so that a hostile name cannot steer a terminal.
 */
#ifndef TOOL_REPORT_H
#define TOOL_REPORT_H

#include <stdbool.h>

#include "brdfpack.h"
#include "command.h"

/* "brdfpack: " and a formatted line; returns EXIT_FAILED, for commands that end with it. */
int report_text(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* "brdfpack: FILE: MATERIAL: " and the error; `file` and `material` may be NULL and are then left out. Returns EXIT_FAILED. */
int report_error(const char *file, const char *material, const bp_error *error);

/* The same with "warning: " before a formatted text. */
void report_warning(const char *file, const char *material, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* The warning that came with a success (BP_OK and a message), if there is one. */
void report_remark(const char *file, const bp_error *error);

/* "brdfpack COMMAND: reason" and where the help is; returns EXIT_USAGE. */
int report_usage(const struct command *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/*
 * The text of an error as report_error shows it, in text[bytes]: the kind ("not an archive",
 * "corrupt at offset N", "unsupported version"), the message, the remedy.
 */
void error_describe(const bp_error *error, char *text, size_t bytes);

/* A name or path on standard output as a terminal may see it (shown.h), and spaces up to `width` columns. */
void text_print(const char *text, int width);

/* Called before every message when it is not NULL: a progress bar removes itself from the line. */
extern void (*report_before)(void);
/* Whether there are worker processes, of which there could be fewer: the pool sets it. */
extern bool report_workers;

#endif
