#include "methods.h"

#include <stdio.h>
#include <string.h>

const struct method METHODS[METHOD_COUNT] = {
	{"paper", &BASELINE_PAPER, false},
	{"spectral", &BASELINE_SPECTRAL, false},
	{"spectral-effort", &BASELINE_SPECTRAL, true},
	{"ward", &BASELINE_WARD, false},
	{"ward-relative", &BASELINE_WARD_RELATIVE, false},
	{"cook-torrance", &BASELINE_COOK_TORRANCE, false},
	{"cook-torrance-relative", &BASELINE_COOK_TORRANCE_RELATIVE, false},
	{"edwards", &BASELINE_EDWARDS, false},
	{"edwards-relative", &BASELINE_EDWARDS_RELATIVE, false},
	{"black", &BASELINE_BLACK, false},
	{"archimedean", &BASELINE_ARCHIMEDEAN, false},
	{"tucker", &BASELINE_TUCKER, false},
	{"zfp", &BASELINE_ZFP, false},
	{"zlib", &BASELINE_ZLIB, false},
	{"zstd", &BASELINE_ZSTD, false},
	{"xz", &BASELINE_XZ, false},
	[METHOD_CAT] = {"cat", NULL, false},
	[METHOD_RAW_TABLE] = {"raw-table", NULL, false},
};

bool methods_choose(const char *list, bool on[METHOD_COUNT], char *unknown, size_t capacity)
{
	memset(on, 0, METHOD_COUNT * sizeof *on);
	for (const char *at = list; *at;) {
		const size_t length = strcspn(at, ",");
		int m = 0;
		while (m < METHOD_COUNT && (strncmp(METHODS[m].name, at, length) || METHODS[m].name[length]))
			m++;
		if (m == METHOD_COUNT) {
			snprintf(unknown, capacity, "%.*s", (int)length, at);
			return false;
		}
		on[m] = true;
		at += length + (at[length] == ',');
	}
	return true;
}
