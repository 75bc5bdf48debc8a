/* paper.c: what fitting and expanding the paper's model share. */
#include "paper.h"

#include <math.h>
#include <stdlib.h>

#include "model/math/fast_math.h"

float paper_step(uint16_t code) { return (float)fast_exp2(((int)code - PAPER_STEP_ONE) / 256.0); }

float paper_coded(uint16_t code) { return code ? (float)fast_exp2(((int)code - (1 << 15)) / 1024.0) : 0; }

uint16_t paper_code(float marginal)
{
	if (!(marginal > 0))
		return 0;
	const long code = lrint(1024 * fast_log2((double)marginal)) + (1 << 15);
	return (uint16_t)(code < 1 ? 1 : code > UINT16_MAX ? UINT16_MAX : code);
}

void sparse_field_free(struct sparse_field *field)
{
	free(field->index);
	free(field->level);
	field->index = NULL;
	field->level = NULL;
	field->count = 0;
}

void sparse_fields_free(struct sparse_field *fields, uint32_t count)
{
	for (uint32_t i = 0; fields && i < count; i++)
		sparse_field_free(&fields[i]);
	free(fields);
}

void paper_free(struct paper_model *paper)
{
	if (!paper)
		return;
	for (int c = 0; c < 3; c++) {
		struct paper_channel *channel = &paper->channel[c];
		for (int axis = 0; axis < 3; axis++)
			free(channel->marginal[axis]);
		sparse_field_free(&channel->hd);
		sparse_field_free(&channel->hphi);
		sparse_fields_free(channel->slice, channel->slice_count);
	}
	free(paper);
}
