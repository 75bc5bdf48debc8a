#include "bands.h"

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
	band_add(out, 0, 0, 0, (theta_h + (1u << levels) - 1) >> levels, (theta_d + (1u << levels) - 1) >> levels, 1);
	for (uint32_t l = levels; l > 0; l--) {
		const uint32_t rows = (theta_h + (1u << (l - 1)) - 1) >> (l - 1), columns = (theta_d + (1u << (l - 1)) - 1) >> (l - 1);
		const uint32_t r = (rows + 1) / 2, c = (columns + 1) / 2;
		band_add(out, 1, 0, c, r, columns - c, l == levels);
		band_add(out, 2, r, 0, rows - r, c, l == levels);
		band_add(out, 3, r, c, rows - r, columns - c, l == levels);
	}
}
