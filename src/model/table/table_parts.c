#include "table_parts.h"

#include <string.h>

#include "error.h"
#include "memory.h"
#include "compact.h"

/* pairs[n + 1].offset of values n = 0 to extent - 1 have been set: sets the rest. */
static void pairs_close(struct table_pair *pairs, uint32_t extent)
{
	pairs[0] = (struct table_pair){.offset = pairs[1].offset, .step = 0};
	for (uint32_t n = 1; n < extent; n++)
		pairs[n].step = pairs[n + 1].offset - pairs[n].offset;
	pairs[extent].step = 0;
}

static struct table_place place_of(const struct table *t, uint32_t k)
{
	if (t->form == TABLE_EXPANDED)
		return (struct table_place){.offset = (uint16_t)(k * (uint32_t)t->channels)};
	const uint32_t in = k % t->width, later = in >= t->half;
	return (struct table_place){
		.offset = (uint16_t)(k / t->width * 2 * t->block_bytes),
		.residual = (uint8_t)(COMPACT_RESIDUALS + in),
		.share = (uint8_t)(COMPACT_SHARES + 3 * later),
		.place = (float)(int32_t)(in - later * t->half) * t->half_reciprocal,
	};
}

/* Where what is looked up stands. */
static void index_fill(struct table *t)
{
	const struct lattice_dims d = t->dims;

	for (uint32_t i = 0; i < d.theta_h; i++)
		t->slices[i + 1].offset = t->slice * i;
	for (uint32_t j = 0; j < d.theta_d; j++)
		t->rows[j + 1].offset = t->form == TABLE_EXPANDED ? t->row * j : t->row * (j / 2) + j % 2 * t->block_bytes;
	for (uint32_t k = 0; k < d.phi_d; k++)
		t->places[k + 1] = place_of(t, k);
	pairs_close(t->slices, d.theta_h);
	pairs_close(t->rows, d.theta_d);
	t->places[0] = t->places[d.phi_d];
	t->places[d.phi_d + 1] = t->places[1];
}

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
	index_fill(t);
	return BP_OK;
}
