#include "progress.h"

#include "report.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static struct {
	bool active, drawn;
	double start, last;
} bar;

double clock_seconds(void)
{
	struct timespec now;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void line_remove(void)
{
	if (bar.drawn)
		fputs("\r\033[K", stderr);
	bar.drawn = false;
}

void progress_start(bool wanted)
{
	bar.active = wanted && isatty(STDERR_FILENO);
	bar.drawn = false;
	bar.start = clock_seconds();
	bar.last = 0;
	if (bar.active)
		report_before = line_remove;
}

static void time_format(char *text, size_t bytes, double seconds)
{
	unsigned s = seconds < 359999 ? (unsigned)(seconds + 0.5) : 359999;
	if (s >= 3600)
		snprintf(text, bytes, "%u:%02u:%02u", s / 3600, s / 60 % 60, s % 60);
	else
		snprintf(text, bytes, "%u:%02u", s / 60, s % 60);
}

void progress_format(char *text, size_t bytes, int columns, uint64_t done, uint64_t total, double fraction, double seconds)
{
	char count[64], left[32] = "-:--", tail[160];
	double share = fraction < 0 ? 0 : fraction > 1 ? 1 : fraction;

	if (total > 0)
		snprintf(count, sizeof count, "%" PRIu64 "/%" PRIu64, done, total);
	else
		snprintf(count, sizeof count, "%" PRIu64, done);
	/* The first second says too little about the rest. */
	if (share > 0 && seconds > 1)
		time_format(left, sizeof left, seconds * (1 - share) / share);
	snprintf(tail, sizeof tail, " %s materials  %.2f/s  %s left", count, seconds > 0 ? (double)done / seconds : 0.0, left);

	int width = columns - (int)strlen(tail) - 3;
	width = width > 40 ? 40 : width;
	if (width < 8 || fraction < 0) {
		snprintf(text, bytes, "%.*s", columns > 1 ? columns - 1 : 0, tail + 1);
		return;
	}
	char cells[41];
	int filled = (int)(share * width);
	for (int i = 0; i < width; i++)
		cells[i] = i < filled ? '#' : '.';
	snprintf(text, bytes, "[%.*s]%s", width, cells, tail);
}

void progress_show(uint64_t done, uint64_t total, double fraction)
{
	double now = clock_seconds();
	if (!bar.active || (bar.drawn && now - bar.last < 0.1))
		return;
	struct winsize size;
	int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
	char text[256];
	progress_format(text, sizeof text, columns, done, total, fraction, now - bar.start);
	fprintf(stderr, "\r%s\033[K", text);
	bar.drawn = true;
	bar.last = now;
}

void progress_stop(void)
{
	line_remove();
	bar.active = false;
	report_before = NULL;
}
