/*
 * encoding.h: bit planes of a fitted model within a budget, in layers.
 *
 * The budget is met in two ways. A step is sought whose planes take about what there is room for; where they take more, the
 * lowest plane is cut off at a harmonic. A percent that is cut off costs more than one that is left over, so what is aimed at
 * is near the room itself.
 */
#ifndef CODEC_SPECTRAL_ENCODING_H
#define CODEC_SPECTRAL_ENCODING_H

#include "planes.h"

struct encoding {
	/* Set before encoding_make: */
	const struct spectral_model *model;
	struct planes *planes; /* for encoding, of the model's extents */
	uint64_t head_bytes;   /* of the record, without any bit planes */
	uint32_t layers;
	uint32_t limit[LAYERS_MAX]; /* record bytes at the end of every layer; the last is the budget */
	const struct watch *watch;  /* told after every unit */
	/* What it leaves: */
	float step, centre[3];
	struct byte_buffer stream[LAYERS_MAX]; /* the contents of the sections */
	uint32_t end[LAYERS_MAX];              /* the unit before which a layer ends */
	uint64_t bytes;                        /* of the record */
};

/* effort: 1..9. Free it by encoding_clear in any case. */
bp_status encoding_make(struct encoding *encoding, int effort, bp_error *error);
void encoding_clear(struct encoding *encoding); /* the streams alone */

#endif
