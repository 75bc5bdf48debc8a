/* The medians as a Markdown table. */
#include <math.h>
#include <stdio.h>

#include "merl/merl_file.h"
#include "eval_timing.h"
#include "timing.h"

static const struct {
	const char *what, *unit, *yardstick;
	enum figure against;
	double scale;
	const char *asked;
} ROWS[FIGURES] = {
	[READ_CACHED] = {"read the raw file, from the page cache", "ms", NULL, 0, 1e3, ""},
	[READ_COLD] = {"read the raw file, from storage", "ms", NULL, 0, 1e3, ""},
	[LOAD_EXPANDED] = {"load, all layers, expanded", "ms", "cached read", READ_CACHED, 1e3,
                       "2.0, and below the read from storage"},
	[LOAD_COMPACT] = {"load, all layers, compact", "ms", "cached read", READ_CACHED, 1e3, "the same"},
	[LOAD_PREVIEW] = {"load, first layer, preview", "ms", "all layers", LOAD_EXPANDED, 1e3, "0.2, 3 ms"},
	[RAW_LIBM] = {"nearest look-up in the raw table, acos and atan2", "ns", NULL, 0, 1e9, ""},
	[RAW_OURS] = {"nearest look-up in the raw table, our angles", "ns", NULL, 0, 1e9, ""},
	[ONE_EXPANDED] = {"evaluate one, interpolated, expanded", "ns", "raw, our angles", RAW_OURS, 1e9, "1.0, 60 ns"},
	[ONE_COMPACT] = {"evaluate one, interpolated, compact", "ns", "raw, our angles", RAW_OURS, 1e9, "1.0, 60 ns"},
	[BATCH_EXPANDED] = {"evaluate 1024, each, expanded", "ns", "raw, our angles", RAW_OURS, 1e9, "15 ns"},
	[BATCH_COMPACT] = {"evaluate 1024, each, compact", "ns", "raw, our angles", RAW_OURS, 1e9, "15 ns"},
	[DRAW] = {"sample and its density", "ns", NULL, 0, 1e9, "200 ns "},
	[DENSITY] = {"density of a given pair", "ns", NULL, 0, 1e9, ""},
};

static double median(struct series *series) { return series->count ? median_of(series->value, series->count) : NAN; }

static void memory_print(const char *what, size_t bytes, const char *asked)
{
	printf("| %s | %.2f MB | raw table | %.2f | %s |\n", what, (double)bytes / 1e6,
	       (double)bytes / (double)merl_file_bytes(LATTICE_MERL), asked);
}

void eval_table_print(struct series all[FIGURES], const size_t memory[2])
{
	double middle[FIGURES];
	for (int n = 0; n < FIGURES; n++)
		middle[n] = median(&all[n]);
	printf("| | median | beside | ratio | asked: at most |\n|---|--:|---|--:|---|\n");
	for (int n = 0; n < FIGURES; n++) {
		if (all[n].count == 0)
			continue;
		printf("| %s | %.1f %s | ", ROWS[n].what, middle[n] * ROWS[n].scale, ROWS[n].unit);
		if (ROWS[n].yardstick)
			printf("%s | %.2f | %s |\n", ROWS[n].yardstick, middle[n] / middle[ROWS[n].against], ROWS[n].asked);
		else
			printf("| | %s|\n", ROWS[n].asked);
	}
	memory_print("memory, expanded, with sampling", memory[0], "9 MB");
	memory_print("memory, compact, with sampling", memory[1], "3 MB");
}
