/* planes_levels.c: coefficients into planes, and levels out of them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "clones.h"
#include "error.h"
#include "memory.h"
#include "model/math/fast_math.h"
#include "planes.h"

enum { LANES = 16 };
static const float LEAST = 0.45f;           /* of a step: what may become 1 in the second quantiser */
static const float CANDIDATES_FROM = 0.85f; /* of the least coefficient that may have a level */

typedef int32_t sizes8 __attribute__((vector_size(LANES / 2 * sizeof(int32_t))));

/* Is any |coefficient| at least the least that does not become 0? Compared as integers, which are in the same order. */
static ALWAYS_INLINE bool any_above(const float *x, int32_t least_bits)
{
	sizes8 low, high;
	uint64_t any[4];
	memcpy(&low, x, sizeof low);
	memcpy(&high, x + LANES / 2, sizeof high);
	low = ((low & 0x7fffffff) >= least_bits) | ((high & 0x7fffffff) >= least_bits);
	memcpy(any, &low, sizeof any);
	return ((any[0] | any[1]) | (any[2] | any[3])) != 0;
}

static bp_status candidate_add(struct planes *p, uint32_t slot, uint32_t place, float coefficient, bp_error *error)
{
	struct candidate *list = memory_grown(p->candidates, p->candidate_count, sizeof *list);
	if (!list)
		return error_memory(error, p->candidate_count * sizeof *list);
	p->candidates = list;
	list[p->candidate_count++] = (struct candidate){slot, place, coefficient};
	return BP_OK;
}

/* Lanes first..first + count - 1, at most LANES, of one cell: slot is that of the cell's block in harmonic 0. */
static bp_status lanes_look(struct planes *p, uint32_t slot, uint32_t place, const float *from, uint32_t first, uint32_t count,
                            float least, bp_error *error)
{
	bp_status status = BP_OK;
	for (uint32_t q = 0; q < count && !status; q++)
		if (fabsf(from[q]) >= least)
			status =
				candidate_add(p, slot + spectrum_harmonic(p->dims.phi_d, first + q) * p->bands.blocks, place, from[q], error);
	return status;
}

/* All coefficients from `least` on. */
AVX2_CLONE static bp_status candidates_find(struct planes *p, float *const coefficient[3], float least, bp_error *error)
{
	const uint32_t lanes = p->dims.phi_d, field = (lanes + 4) * p->bands.blocks;
	bp_status status = BP_OK;

	p->candidate_count = 0;
	p->candidate_least = least;
	for (uint32_t f = 0; f < 3; f++)
		for (uint32_t b = 0; b < p->bands.count; b++) {
			const struct band *band = &p->bands.band[b];
			for (uint32_t y = 0; y < band->rows; y++)
				for (uint32_t x = 0; x < band->columns && !status; x++) {
					const float *row = coefficient[f] + ((size_t)(band->row + y) * p->dims.theta_d + band->column + x) * lanes;
					const uint32_t slot =
						f * field + 2 * p->bands.blocks + band->block_at + y / BLOCK_EDGE * band->block_stride + x / BLOCK_EDGE;
					const uint32_t place = y % BLOCK_EDGE * BLOCK_EDGE + x % BLOCK_EDGE;
					for (uint32_t lane = 0; lane < lanes && !status; lane += LANES)
						if (lanes - lane < LANES || any_above(row + lane, (int32_t)bits_of_float(least)))
							status = lanes_look(p, slot, place, row + lane, lane, lanes - lane < LANES ? lanes - lane : LANES,
							                    least, error);
				}
		}
	return status;
}

/* The coefficient's level, in its block, which gets a place in the pool where it has none and the level is not 0. */
static inline void level_place(struct planes *p, const struct candidate *c, float inverse)
{
	const uint32_t most = (1u << SPECTRAL_PLANES_MAX) - 3; /* settling may add 2 */
	const float size = fabsf(c->coefficient) * inverse;
	uint32_t level = (uint32_t)(size + LEVEL_ROUNDING), *slot = &p->level_slot[0][c->slot];

	if (!level && !*slot)
		return;
	level = level < most ? level : most;
	if (!*slot) {
		*slot = p->levels_count++;
		memset(&p->levels[*slot], 0, sizeof *p->levels);
	}
	struct level_block *block = &p->levels[*slot];
	block->level[c->place] = c->coefficient < 0 ? -(int32_t)level : (int32_t)level;
	block->over[c->place] = (uint8_t)fminf(256 * (size + LEVEL_ROUNDING - (float)level), 255);
	block->near[c->place] = (uint8_t)(level < LEVEL_NEAR_MOST ? level : LEVEL_NEAR_MOST);
	block->there |= UINT64_C(1) << c->place;
	block->negative |= (uint64_t)(c->coefficient < 0) << c->place;
}

static void levels_clear(struct planes *p)
{
	p->levels_count = 1;
	memset(p->level_slot[0], 0, 3 * (size_t)(p->dims.phi_d + 4) * p->bands.blocks * sizeof *p->level_slot[0]);
}

bp_status planes_quantise(struct planes *p, float *const coefficient[3], float step, bp_error *error)
{
	const float least = LEAST * step, inverse = 1 / step;

	/* The next step is about as large. */
	const bp_status status = p->candidate_count && least >= p->candidate_least
	                             ? BP_OK
	                             : candidates_find(p, coefficient, CANDIDATES_FROM * least, error);
	if (status)
		return status;
	levels_clear(p);
	for (uint32_t n = 0; n < p->candidate_count; n++)
		if (fabsf(p->candidates[n].coefficient) >= (1 - LEVEL_ROUNDING) * step)
			level_place(p, &p->candidates[n], inverse);
	/* Smaller ones only where something is. */
	for (uint32_t n = 0; n < p->candidate_count; n++) {
		const float size = fabsf(p->candidates[n].coefficient);
		if (size >= least && size < (1 - LEVEL_ROUNDING) * step)
			level_place(p, &p->candidates[n], inverse);
	}
	return BP_OK;
}

/* Stores the levels of one band of one harmonic, which are at most its cells, and returns how many they are. */
static uint32_t band_collect(const struct planes *p, uint32_t field, uint32_t harmonic, uint32_t lowest, uint32_t b,
                             struct spectral_level *out)
{
	const struct band *band = &p->bands.band[b];
	const uint32_t *slot = p->slot[field] + (size_t)(harmonic + 2) * p->bands.blocks + band->block_at;
	const size_t field0 = field * lattice_cells(p->dims) + spectrum_lane(p->dims.phi_d, harmonic);
	uint32_t n = 0;

	if (!(p->bands_active[field][harmonic + 2] >> b & 1))
		return 0;
	for (uint32_t by = 0; by < band->block_rows; by++)
		for (uint32_t bx = 0; bx < band->block_columns; bx++) {
			const uint32_t place = slot[by * band->block_stride + bx];
			const struct plane_block *block = &p->pool[place];
			for (uint32_t y = 0; place && y < BLOCK_EDGE; y++) {
				const size_t row = (size_t)(band->row + by * BLOCK_EDGE + y) * p->dims.theta_d + band->column + bx * BLOCK_EDGE;
				uint64_t any;
				memcpy(&any, block->sign + y * BLOCK_EDGE, sizeof any);
				for (uint32_t x = 0; any && x < BLOCK_EDGE; x++) {
					const uint32_t k = y * BLOCK_EDGE + x;
					const int32_t size = (int32_t)(block->known[k] >> 2 >> lowest << lowest);
					if (!size)
						continue;
					out[n++] = (struct spectral_level){.at = (uint32_t)(field0 + (row + x) * p->dims.phi_d),
					                                   .level = block->sign[k] == 2 ? -size : size};
				}
			}
		}
	return n;
}

bp_status planes_collect(const struct planes *p, uint32_t end, struct spectral_level **out, uint32_t *count, bp_error *error)
{
	struct spectral_level *levels = NULL;
	uint32_t n = 0, room = 0;

	for (uint32_t f = 0; f < 3; f++)
		for (uint32_t m = 0; m < p->dims.phi_d; m++) {
			const uint32_t lowest = spectral_lowest_plane(p->planes, p->dims.phi_d, end, f, m);
			if (room - n < p->dims.theta_h * p->dims.theta_d) {
				room = room * 2 + p->dims.theta_h * p->dims.theta_d;
				struct spectral_level *larger = realloc(levels, room * sizeof *levels);
				if (!larger) {
					free(levels);
					return error_memory(error, room * sizeof *levels);
				}
				levels = larger;
			}
			for (uint32_t b = 0; b < p->bands.count; b++)
				n += band_collect(p, f, m, lowest, b, levels + n);
		}
	*out = levels;
	*count = n;
	return BP_OK;
}
