#include "paper_plane.h"

uint32_t paper_shared_from(uint32_t theta_h)
{
	uint32_t i = 0;

	while ((uint64_t)9 * i * i < (uint64_t)4 * theta_h * theta_h)
		i++;
	return i;
}

void paper_field_extents(struct lattice_dims dims, enum paper_field field, uint32_t *rows, uint32_t *columns)
{
	*rows = field == PAPER_SLICE ? dims.theta_d : dims.theta_h;
	*columns = field == PAPER_HD ? dims.theta_d : dims.phi_d;
}

struct wavelet_plane paper_plane(struct lattice_dims dims, enum paper_field field)
{
	uint32_t rows, columns;

	paper_field_extents(dims, field, &rows, &columns);
	return wavelet_plane_for(field == PAPER_SLICE ? WAVELET_DAUBECHIES : WAVELET_HAAR, rows, columns, field != PAPER_HD);
}

uint32_t paper_plane_cells(struct lattice_dims dims, enum paper_field field)
{
	const struct wavelet_plane plane = paper_plane(dims, field);
	return (uint32_t)wavelet_cells(&plane);
}

/* 0 for the coarse coefficients of an axis, then 1 for the coarsest details. */
static uint32_t level_of(struct wavelet_axis axis, uint32_t at)
{
	uint32_t level = 0;

	while (level < axis.levels && at >= axis.plane >> (axis.levels - level))
		level++;
	return level;
}

void paper_plane_bands(struct lattice_dims dims, enum paper_field field, uint8_t *band)
{
	const struct wavelet_plane p = paper_plane(dims, field);

	for (uint32_t column = 0; column < p.columns.plane * p.parts; column++)
		for (uint32_t row = 0; row < p.rows.plane; row++)
			band[(size_t)column * p.rows.plane + row] =
				(uint8_t)(level_of(p.columns, column % p.columns.plane) + level_of(p.rows, row));
}

uint32_t paper_keep(struct lattice_dims dims, enum paper_field field)
{
	uint32_t rows, columns;

	paper_field_extents(dims, field, &rows, &columns);
	const uint32_t one = rows * columns / (field == PAPER_SLICE ? PAPER_KEEP_SLICE : PAPER_KEEP_PAIR);
	return (one ? one : 1) * (field == PAPER_SLICE ? paper_shared_from(dims.theta_h) + 1 : 1);
}
