#include "planes_contexts.h"

/* With nothing around it that is known to differ from 0, a cell, row, block or band starts at 1/50, as if of six bits. */
enum { QUIET_START = 83886 << 10 | 6 };

void plane_contexts_reset(struct plane_contexts *c)
{
	static const uint16_t least[SIZES] = {0, 1, 2, 3, 4, 7, 11, 16, 26, 41, 64, 102, 162, 256, 407, 646};
	mixer_context *mixed = (mixer_context *)&c->mixed, *quiet = (mixer_context *)&c->quiet;

	for (size_t i = 0; i < sizeof c->mixed / sizeof *mixed; i++)
		mixed[i] = MIXER_CONTEXT_EVEN;
	for (size_t i = 0; i < sizeof c->quiet / sizeof *quiet; i++)
		quiet[i] = QUIET_START;
	for (int set = 0; set < 2; set++)
		for (int i = 0; i < MIXER_INPUTS; i++)
			c->sign_weights[set].w[i] = MIXER_WEIGHT_START;
	for (uint32_t v = 0, size = 0; v < SIZE_TABLE; v++) {
		size += size + 1 < SIZES && v >= least[size + 1];
		c->size[v] = (uint8_t)size;
	}
}
