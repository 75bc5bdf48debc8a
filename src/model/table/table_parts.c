#include "table_parts.h"

#include <string.h>

#include "error.h"
#include "memory.h"

bp_status table_store_alloc(struct table *t, size_t cells_bytes, bp_error *error)
{
	const size_t slices = t->dims.theta_h + 1, rows = t->dims.theta_d + 1, places = t->dims.phi_d + 2;
	const size_t behind = (cells_bytes + TABLE_SLACK_BYTES + 7) & ~(size_t)7;
	t->store_bytes = behind + (slices + rows) * sizeof *t->slices + places * sizeof *t->places;
	t->store = memory_alloc_kept(t->store_bytes);
	if (!t->store)
		return error_memory(error, t->store_bytes);
	memset(t->store + cells_bytes, 0, behind - cells_bytes);
	t->slices = (struct table_pair *)(void *)(t->store + behind);
	t->rows = t->slices + slices;
	t->places = (struct table_place *)(void *)(t->rows + rows);
	return BP_OK;
}

void table_pairs_close(struct table_pair *pairs, uint32_t extent)
{
	pairs[0] = (struct table_pair){.offset = pairs[1].offset, .step = 0};
	for (uint32_t n = 1; n < extent; n++)
		pairs[n].step = pairs[n + 1].offset - pairs[n].offset;
	pairs[extent].step = 0;
}

void table_places_close(struct table_place *places, uint32_t extent)
{
	places[0] = places[extent];
	places[extent + 1] = places[1];
}
