/*
 * planes_contexts.h: what the coder of bit planes has learnt so far (FORMAT.md, "Bit planes", has the meaning of indices).
 *
 * Most bits have a pair of contexts, signs a mix of four, and a quiet bit, one with nothing around it that is known to differ
 * from 0, a single one.
 */
#ifndef CODEC_SPECTRAL_PLANES_CONTEXTS_H
#define CODEC_SPECTRAL_PLANES_CONTEXTS_H

#include "codec/bit_mixer.h"
#include "model/spectral/spectral.h"

enum { BANDS_MAX = 3 * SPECTRUM_LEVELS_MAX + 1, BLOCK_EDGE = 8, BLOCK_CELLS = BLOCK_EDGE * BLOCK_EDGE };
enum { HARMONIC_CLASSES = 8, SIZES = 16, SIZE_TABLE = 647 };

struct plane_contexts {
	struct mixed_contexts {
		mixer_context band[2][120];
		mixer_context block[2][BANDS_MAX * 54];
		mixer_context zero[2][64 * SIZES * SIZES]; /* the second uses 81 * 81 */
		mixer_context refine[2][6 * BANDS_MAX * SIZES];
		mixer_context first[BLOCK_EDGE]; /* of a row with nothing around it: is it this one? by how many may follow */
		mixer_context sign[MIXER_INPUTS][81 * 4];
	} mixed;
	struct quiet_contexts {
		mixer_context band[HARMONIC_CLASSES * 2], block[HARMONIC_CLASSES * BANDS_MAX * 2];
		mixer_context row[HARMONIC_CLASSES * BANDS_MAX * 12], cell[HARMONIC_CLASSES * BANDS_MAX * 12];
	} quiet;
	struct mixer_weights sign_weights[2];
	uint8_t size[SIZE_TABLE]; /* size(v); what is larger has the last one's */
};

#endif
