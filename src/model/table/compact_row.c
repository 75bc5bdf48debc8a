#include "compact_row.h"

#include <string.h>

void compact_hats_make(uint32_t width, uint32_t half, struct compact_hats *out)
{
	float system[5] = {0};
	memset(out, 0, sizeof *out);
	out->width = width;
	out->half = half;
	for (uint32_t k = 0; k <= width; k++) {
		uint32_t m = k < half ? 0 : 1;
		float t = (float)(k - m * half) / (float)half;
		out->h[m][k] = 1 - t;
		out->h[m + 1][k] = t;
	}
	for (int n = 0; n < 5; n++)
		for (uint32_t k = 0; k <= width; k++) {
			out->product[n][k] = out->h[n / 2][k] * out->h[(n + 1) / 2][k];
			system[n] += out->product[n][k];
		}
	for (uint32_t k = 0; k <= width; k++) {
		float x[3] = {out->h[0][k], out->h[1][k], out->h[2][k]};
		compact_solve(system, x);
		for (int a = 0; a < 3; a++)
			out->fit[a][k] = x[a];
	}
}
