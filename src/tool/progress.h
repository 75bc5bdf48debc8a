/*
 * progress.h: one line on a terminal that says how far the work is. Anywhere else it stays silent.
 */
#ifndef TOOL_PROGRESS_H
#define TOOL_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Starts the clock. Shows nothing when !wanted or when standard error is not a terminal. */
void progress_start(bool wanted);

/*
 * `done` of `total` materials are finished (total 0: not known, as in a stream); `fraction` of
 * the work is done (0..1; negative: not known, and no bar is drawn). Redraws at most ten times a second.
 */
void progress_show(uint64_t done, uint64_t total, double fraction);

/* Removes the line. Messages do so by themselves (report_before). */
void progress_stop(void);

/* The line as it would be drawn, in text[bytes], for `columns` columns; progress_show prints this. */
void progress_format(char *text, size_t bytes, int columns, uint64_t done, uint64_t total, double fraction, double seconds);

/* Seconds of a clock that never goes back. */
double clock_seconds(void);

#endif
