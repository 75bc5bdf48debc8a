/*
 * planes.h: the bit planes of the spectral profile's levels, coded with mixed contexts (FORMAT.md, "Bit planes").
 *
 * A unit is one plane of one harmonic of one field. Units must be coded in order from 0: what has been coded is the
 * context of what follows, in the encoder and in the decoder alike.
 */
#ifndef CODEC_SPECTRAL_PLANES_H
#define CODEC_SPECTRAL_PLANES_H

#include "model/spectral/spectral.h"
#include "codec/bit_mixer.h"
#include "bands.h"

enum { BLOCK_CELLS = BLOCK_EDGE * BLOCK_EDGE };

/*
 * What is known of the levels of one block, row by row; 0 behind the band's end. What stands for a neighbour's contexts comes
 * first: it is read far more often than the rest.
 */
struct plane_block {
	uint16_t near[BLOCK_CELLS];  /* known / 2^p, p being the plane last coded here; at most NEAR_MOST */
	uint8_t sign[BLOCK_CELLS];   /* 0: the level is 0 so far, 1: positive, 2: negative */
	uint32_t known[BLOCK_CELLS]; /* 4 |level| as far as it is known, with half of the last known plane added */
};
enum { NEAR_MOST = 2047 }; /* more is as much: the largest size of all sums begins at 646, and half of a sum counts as well */

/* Encoder: the levels of one block, and where in its interval the coefficient lies: 256 (size / step + rounding - |level|). */
struct level_block {
	int32_t level[BLOCK_CELLS];
	uint8_t over[BLOCK_CELLS];
};

/* Encoder: a coefficient that may have a level. */
struct candidate {
	uint32_t slot, place; /* of its block, from level_slot[0] on; in the block */
	float coefficient;
};

/*
 * Most blocks never hold a level. Those that do have a place in a pool, in the order in which they were met, so that what is
 * worked on lies close together whatever the lattice's size.
 */
struct planes {
	struct lattice_dims dims;
	struct bands bands;
	uint32_t planes;
	/* Per field, [harmonic][block], with two harmonics of zeros before and behind. */
	uint32_t *slot[3];         /* the block's place in the pool; 0, a block of zeros, where all its levels are 0 so far */
	uint8_t *active[3];        /* 1 where there is a slot */
	uint32_t *bands_active[3]; /* [harmonic]: bit b is 1 where band b holds a block that is active */
	struct plane_block *pool;
	uint32_t pool_count, pool_room;
	/* Encoder only: the levels, in a pool of their own, and, per block, the planes that its largest one needs. */
	uint32_t *level_slot[3]; /* one behind the other */
	uint8_t *top[3];
	struct level_block *levels;
	uint32_t levels_count;
	/* Encoder only: all coefficients of at least candidate_least, so that every further step looks at these alone. */
	struct candidate *candidates;
	uint32_t candidate_count;
	float candidate_least;
	struct plane_contexts *contexts;
	void *block; /* the one allocation behind the arrays but for the pools */
};

bp_status planes_create(struct lattice_dims dims, int encoder, struct planes **out, bp_error *error);
void planes_free(struct planes *planes); /* NULL is allowed */

/* Forgets everything coded; `count` planes, 0..SPECTRAL_PLANES_MAX, are to come. */
void planes_start(struct planes *planes, uint32_t count);

/*
 * Encoder: level = floor(|coefficient| / step + rounding), with the coefficient's sign. The coefficients must be the same every
 * time. planes_settle must follow.
 */
bp_status planes_quantise(struct planes *planes, float *const coefficient[3], float step, float rounding, bp_error *error);

/*
 * Counts the planes that the levels need and returns them. Levels of 1 with little around them become 0 before, the
 * less there is the larger they may be, as they cost most to place. `rounding` is that of planes_quantise.
 * centre[0], centre[1]: the mean of |coefficient|/step - |level| over levels of 1 and over larger ones, to 1/256.
 */
uint32_t planes_settle(struct planes *planes, float rounding, float centre[2]);

static inline uint32_t planes_units(const struct planes *planes) { return planes->planes * 3 * planes->dims.phi_d; }
static inline uint32_t planes_unit_plane(const struct planes *planes, uint32_t unit)
{
	return planes->planes - 1 - unit / (3 * planes->dims.phi_d);
}
void planes_encode_unit(struct planes *planes, struct mixed_coder *coder, uint32_t unit);
/* BP_ERROR_MEMORY where the pool cannot grow; nothing was decoded then. */
bp_status planes_decode_unit(struct planes *planes, struct mixed_coder *coder, uint32_t unit, bp_error *error);

/* Decoder: the pool has room for all blocks that one more unit may take. */
bp_status planes_pool_grow(struct planes *planes, bp_error *error);

/* The levels as units 0..end-1 tell them: malloc'ed, ordered by field, harmonic, band, block and place. */
bp_status planes_collect(const struct planes *planes, uint32_t end, struct spectral_level **out, uint32_t *count,
                         bp_error *error);

#endif
