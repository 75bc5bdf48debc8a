#include "planes.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"

/* ---- bands ---- */

static void band_add(struct bands *bands, uint32_t orientation, uint32_t row, uint32_t column, uint32_t rows, uint32_t columns,
                     int coarsest)
{
	struct band *b = &bands->band[bands->count];
	*b = (struct band){.row = row, .column = column, .rows = rows, .columns = columns, .orientation = orientation};
	b->parent = orientation == 0 ? -1 : coarsest ? 0 : (int32_t)bands->count - 3;
	b->parent_shift = !coarsest;
	b->block_rows = (rows + BLOCK_EDGE - 1) / BLOCK_EDGE;
	b->block_columns = (columns + BLOCK_EDGE - 1) / BLOCK_EDGE;
	b->block_stride = b->block_columns + 2;
	b->block_at = bands->blocks + b->block_stride + 1;
	bands->blocks += (b->block_rows + 2) * b->block_stride;
	bands->count++;
}

void bands_lay_out(uint32_t theta_h, uint32_t theta_d, struct bands *out)
{
	const uint32_t levels = spectrum_levels(theta_h, theta_d);
	*out = (struct bands){0};
	band_add(out, 0, 0, 0, spectrum_extent(theta_h, levels), spectrum_extent(theta_d, levels), 1);
	for (uint32_t l = levels; l > 0; l--) {
		const uint32_t rows = spectrum_extent(theta_h, l - 1), columns = spectrum_extent(theta_d, l - 1);
		const uint32_t r = spectrum_extent(theta_h, l), c = spectrum_extent(theta_d, l);
		band_add(out, 1, 0, c, r, columns - c, l == levels);
		band_add(out, 2, r, 0, rows - r, c, l == levels);
		band_add(out, 3, r, c, rows - r, columns - c, l == levels);
	}
}

/* ---- contexts ---- */

/* With nothing around it that is known to differ from 0, a cell, row, block or band starts at 1/50, as if of six bits. */
enum { QUIET_START = 83886 << 10 | 6 };

static void contexts_reset(struct plane_contexts *c)
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

/* ---- planes ---- */

/*
 * Blocks that a decoder's pool begins with: enough for a preview, and small enough to stay with the process from material to
 * material; larger ones go back to the system. An encoder's has room for all there can be.
 */
enum { POOL_START = 2048, POOL_GROWTH = 8 };

bp_status planes_create(struct lattice_dims dims, int encoder, struct planes **out, bp_error *error)
{
	struct planes *p = calloc(1, sizeof *p);

	if (!p)
		return error_memory(error, sizeof *p);
	p->dims = dims;
	bands_lay_out(dims.theta_h, dims.theta_d, &p->bands);
	const size_t harmonics = (size_t)dims.phi_d + 4, blocks = harmonics * p->bands.blocks, slots = 3 * blocks + 1;
	const size_t bytes = 3 * blocks * (encoder ? 10 : 5) + 3 * harmonics * sizeof(uint32_t);
	unsigned char *at = p->block = calloc(bytes, 1);
	/*
	 * Pages that are never touched cost nothing, and those that are come in huge ones. Not calloc: a worker's memory has been in
	 * use before, and 100 MB would be zeroed for every material. Who takes a place zeroes it.
	 */
	p->pool_room = (uint32_t)(encoder || slots < POOL_START ? slots : POOL_START);
	p->pool = memory_alloc(p->pool_room * sizeof *p->pool);
	p->levels = encoder ? memory_alloc(slots * sizeof *p->levels) : NULL;
	p->cells = encoder ? memory_alloc((size_t)dims.theta_h * dims.theta_d * sizeof *p->cells) : NULL;
	p->costs = encoder ? memory_alloc((size_t)dims.theta_h * dims.theta_d * sizeof *p->costs) : NULL;
	if (!at || !p->pool || (encoder && !(p->levels && p->cells && p->costs))) {
		planes_free(p);
		return error_memory(error, slots * sizeof *p->pool);
	}
	memset(p->pool, 0, sizeof *p->pool);
	if (encoder)
		memset(p->levels, 0, sizeof *p->levels);
	p->pool_count = p->levels_count = 1;
	/* The wider ones first, so that all are aligned. */
	for (int f = 0; f < 3; f++, at += blocks * sizeof(uint32_t))
		p->slot[f] = (uint32_t *)(void *)at;
	for (int f = 0; f < 3 && encoder; f++, at += blocks * sizeof(uint32_t))
		p->level_slot[f] = (uint32_t *)(void *)at;
	for (int f = 0; f < 3; f++, at += harmonics * sizeof(uint32_t))
		p->bands_active[f] = (uint32_t *)(void *)at;
	for (int f = 0; f < 3; f++, at += blocks)
		p->active[f] = at;
	for (int f = 0; f < 3 && encoder; f++, at += blocks)
		p->top[f] = at;
	contexts_reset(&p->contexts);
	*out = p;
	return BP_OK;
}

bp_status planes_pool_grow(struct planes *p, bp_error *error)
{
	const uint32_t needed = p->pool_count + p->bands.blocks;
	if (needed <= p->pool_room)
		return BP_OK;
	const uint32_t room = needed > p->pool_room * POOL_GROWTH ? needed : p->pool_room * POOL_GROWTH;
	struct plane_block *larger = memory_alloc(room * sizeof *larger);
	if (!larger)
		return error_memory(error, room * sizeof *larger);
	memcpy(larger, p->pool, p->pool_count * sizeof *larger);
	free(p->pool);
	p->pool = larger;
	p->pool_room = room;
	return BP_OK;
}

void planes_free(struct planes *p)
{
	if (!p)
		return;
	free(p->block);
	free(p->pool);
	free(p->levels);
	free(p->cells);
	free(p->costs);
	free(p->candidates);
	free(p);
}

void planes_start(struct planes *p, uint32_t count)
{
	const size_t harmonics = (size_t)p->dims.phi_d + 4, blocks = harmonics * p->bands.blocks;
	for (int f = 0; f < 3 && p->pool_count > 1; f++) {
		memset(p->slot[f], 0, blocks * sizeof *p->slot[f]);
		memset(p->active[f], 0, blocks);
		memset(p->bands_active[f], 0, harmonics * sizeof *p->bands_active[f]);
	}
	p->pool_count = 1;
	p->planes = count;
	contexts_reset(&p->contexts);
}
