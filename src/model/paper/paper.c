/* paper.c: what fitting and expanding the paper's model share. */
#include "paper.h"

#include <stdlib.h>

#include "wavelet.h"

uint32_t paper_plane_cells(uint32_t rows, uint32_t columns)
{
	return wavelet_axis_for(rows).plane * wavelet_axis_for(columns).plane;
}

uint32_t paper_shared_from(uint32_t theta_h)
{
	uint32_t i = 0;

	while ((uint64_t)9 * i * i < (uint64_t)4 * theta_h * theta_h)
		i++;
	return i;
}

static void field_free(struct sparse_field *field)
{
	free(field->index);
	free(field->level);
}

void paper_free(struct paper_model *paper)
{
	if (!paper)
		return;
	for (int axis = 0; axis < 3; axis++)
		free(paper->marginal[axis]);
	field_free(&paper->hd);
	field_free(&paper->hphi);
	for (uint32_t i = 0; paper->slice && i < paper->slice_count; i++)
		field_free(&paper->slice[i]);
	free(paper->slice);
	free(paper);
}
