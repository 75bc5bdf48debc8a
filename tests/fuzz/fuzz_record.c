/*
 * The record decoder: the input is a record whose checksums are mended. Whatever it holds: an error, or finite values.
 *
 * See tests/fuzz/run.
 */
#include <math.h>
#include <stdlib.h>

#include "mend.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);

struct memory {
	const uint8_t *bytes;
	size_t count;
};

static bp_status fetch(void *user, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error)
{
	const struct memory *memory = user;
	(void)error;
	if (offset > memory->count || count > memory->count - offset)
		return BP_ERROR_CORRUPT;
	memcpy(bytes, memory->bytes + offset, count);
	return BP_OK;
}

static void expand_all(const struct model *model)
{
	struct expansion table = { 0 };
	if (lattice_cells(model->dims) > 4096 || expansion_alloc(model->dims, &table, NULL) != BP_OK)
		return;
	if (model_expand(model, 0, &table, NULL) == BP_OK)
		for (int c = 0; c < 3; c++)
			for (size_t i = 0; i < lattice_cells(model->dims); i++)
				if (!(table.rgb[c][i] >= 0) || !isfinite(table.unit * (double)table.rgb[c][i]))
					abort();
	expansion_free(&table);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	uint8_t *record = malloc(count + 1);
	struct memory memory = { record, count };
	struct record_head head;
	memcpy(record, data, count);
	mend_record(record, count);
	if (record_head_parse(record, count, &head, NULL) == BP_OK)
		for (uint32_t layers = 1; layers <= head.layer_count; layers++) {
			struct model *model = NULL;
			if (record_decode(&head, layers, fetch, &memory, &model, NULL) == BP_OK)
				expand_all(model);
			model_free(model);
		}
	free(record);
	return 0;
}
