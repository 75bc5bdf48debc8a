/* The record decoder on arbitrary bytes with mended checksums: head, sections of every layer, expansion. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "archive_walk.h"
#include "codec/record.h"

struct input {
	const uint8_t *bytes;
	size_t count;
};

static bp_status input_fetch(void *user, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error)
{
	const struct input *input = user;
	(void)error;
	if (offset > input->count || count > input->count - offset)
		return BP_ERROR_CORRUPT;
	memcpy(bytes, input->bytes + offset, count);
	return BP_OK;
}

static void layers_decode(const struct record_head *head, struct input *input, uint32_t layers)
{
	struct expansion table = {0};
	struct model *model = NULL;
	if (record_decode(head, layers, input_fetch, input, &model, NULL) != BP_OK)
		return;
	if (expansion_alloc(head->dims, &table, NULL) == BP_OK && model_expand(model, 0, &table, NULL) == BP_OK)
		for (int c = 0; c < 3; c++)
			for (size_t i = 0; i < lattice_cells(head->dims); i++) {
				const double value = table.unit * (double)table.rgb[c][i];
				if (!(value >= 0 && isfinite(value)))
					abort();
			}
	expansion_free(&table);
	model_free(model);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	uint8_t *copy = malloc(count + 1), *kept = NULL;
	struct input input = {copy, count};
	struct record_head head;
	size_t kept_bytes;

	memcpy(copy, data, count);
	record_mend(copy, count);
	if (record_head_parse(copy, count, &head, NULL) == BP_OK && lattice_cells(head.dims) <= WALK_CELLS_MAX) {
		layers_decode(&head, &input, 1);
		layers_decode(&head, &input, 0);
		if (record_keep_layers(copy, count, 1, &kept, &kept_bytes, NULL) == BP_OK)
			free(kept);
	}
	free(copy);
	return 0;
}
