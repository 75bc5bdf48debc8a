#include "planes.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "planes_contexts.h"

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
	p->contexts = malloc(sizeof *p->contexts);
	if (!at || !p->pool || (encoder && !(p->levels && p->cells && p->costs)) || !p->contexts) {
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
	plane_contexts_reset(p->contexts);
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
	free(p->contexts);
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
	plane_contexts_reset(p->contexts);
}
