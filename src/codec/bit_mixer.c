#include "bit_mixer.h"

#include <math.h>

/* No value of these formulas lies nearer than 9e-5 to a half, so any decent libm rounds alike. */
static void tables_fill(struct mixer_tables *tables)
{
	for (int i = 0; i < 4096; i++) {
		const double p = (i + 0.5) / 4096, s = 256 * log(p / (1 - p)), q = 65536 / (1 + exp(-(i - 2048) / 256.0));
		tables->stretch[i] = (int16_t)floor((s < -2047 ? -2047 : s > 2047 ? 2047 : s) + 0.5);
		tables->squash[i] = (uint16_t)floor((q < 16 ? 16 : q > 65520 ? 65520 : q) + 0.5);
	}
	for (uint32_t n = 0; n < 256; n++) {
		const uint32_t rate = 655360 / (10 * n + 16);
		tables->rate[n] = rate < 32767 ? rate : 32767;
	}
}

const struct mixer_tables *mixer_tables_get(void)
{
	static struct mixer_tables tables;
	static int ready; /* 0 nothing, 1 somebody is at it, 2 done */
	int expected = 0;

	if (__atomic_load_n(&ready, __ATOMIC_ACQUIRE) == 2)
		return &tables;
	if (__atomic_compare_exchange_n(&ready, &expected, 1, 0, __ATOMIC_ACQUIRE, __ATOMIC_ACQUIRE)) {
		tables_fill(&tables);
		__atomic_store_n(&ready, 2, __ATOMIC_RELEASE);
	} else {
		while (__atomic_load_n(&ready, __ATOMIC_ACQUIRE) != 2) {
		}
	}
	return &tables;
}
