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
#include "trellis.h"

enum { BANDS_MAX = 3 * SPECTRUM_LEVELS_MAX + 1, BLOCK_EDGE = 8, BLOCK_CELLS = BLOCK_EDGE * BLOCK_EDGE };

/*
 * The plane of H x D wavelet coefficients of a harmonic falls into bands (FORMAT.md, "Bands"), the coarse one first, and a band
 * into blocks of 8 x 8 (fewer at its end). Blocks have numbers; around each band's is one block of padding, so that neighbours
 * need no test.
 */
struct band {
	uint32_t row, column, rows, columns; /* in the plane of coefficients */
	uint32_t orientation;                /* bit 0: detail along theta_d, bit 1: along theta_h */
	int32_t parent;        /* the band of the same orientation one level coarser, band 0 at the coarsest level, -1 for band 0 */
	uint32_t parent_shift; /* 1: a parent's cell stands for 2 x 2; 0 at the coarsest level */
	uint32_t block_rows, block_columns, block_at, block_stride;
};

struct bands {
	uint32_t count;
	uint32_t blocks; /* of a plane, padding included */
	struct band band[BANDS_MAX];
};

void bands_lay_out(uint32_t theta_h, uint32_t theta_d, struct bands *out);

/*
 * What the coder has learnt so far (FORMAT.md, "Bit planes", has the meaning of indices).
 *
 * Most bits have a pair of contexts, signs a mix of four, and a quiet bit, one with nothing around it that is known to differ
 * from 0, a single one.
 */
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

/* Encoder: the levels of one block, and what they are chosen by. */
struct level_block {
	int32_t level[BLOCK_CELLS];
	uint8_t over[BLOCK_CELLS]; /* of a candidate: 256 (size / step + 0.4 - |level|) before levels are settled */
	uint8_t near[BLOCK_CELLS]; /* |level|, at most LEVEL_NEAR_MOST */
	uint64_t there, negative;  /* bit k: cell k holds a candidate; its coefficient is below 0 */
};
enum { LEVEL_NEAR_MOST = 255 };
#define LEVEL_ROUNDING 0.4f

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
	struct trellis_cell *cells; /* room for those of a harmonic */
	struct trellis_costs *costs;
	/* Encoder only: all coefficients of at least candidate_least, so that every further step looks at these alone. */
	struct candidate *candidates;
	uint32_t candidate_count;
	float candidate_least;
	struct plane_contexts contexts;
	void *block; /* the one allocation behind the arrays but for the pools */
};

bp_status planes_create(struct lattice_dims dims, int encoder, struct planes **out, bp_error *error);
void planes_free(struct planes *planes); /* NULL is allowed */

/* Forgets everything coded; `count` planes, 0..SPECTRAL_PLANES_MAX, are to come. */
void planes_start(struct planes *planes, uint32_t count);

/*
 * Encoder: level = floor(|coefficient| / step + 0.4), with the coefficient's sign: near what planes_settle, which must follow,
 * makes of it. The coefficients must be the same every time.
 */
bp_status planes_quantise(struct planes *planes, float *const coefficient[3], float step, bp_error *error);

/*
 * Chooses the levels, harmonic by harmonic (trellis.h), and returns the number of planes that they need. centre[0], [1] and
 * [2]: the mean of |coefficient|/step less what the level stands for over levels of 1 in the first quantiser, of 1 in the
 * second, and larger ones.
 */
uint32_t planes_settle(struct planes *planes, float centre[3]);

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
