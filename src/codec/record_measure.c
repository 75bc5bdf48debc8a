#include "record_measure.h"

#include <stdlib.h>

#include "model/fidelity.h"
#include "stage.h"

/* Layers that are measured in one pass over the measured table: what the previews of a usual budget and the whole are. */
enum { MEASURED_AT_ONCE = 3, MEASURED_CELLS_MAX = 1 << 22 };

/* Expands layer `l` of `decoded`, or, where there is none, decodes it from the record's own bytes. */
static bp_status layer_expand(const struct record_head *head, const uint8_t *record, const struct model *decoded, uint32_t l,
                              struct expansion *table, bp_error *error)
{
	struct model *model = NULL;
	bp_status status = BP_OK;
	if (!decoded)
		status = record_decode_whole(head, l + 1, record, &model, error);
	if (!status)
		status = model_expand(decoded ? decoded : model, l + 1, table, error);
	model_free(model);
	return status;
}

/* Fills in the figures of every layer. */
static bp_status layers_measure(struct record_head *head, const uint8_t *record, const struct lattice *lattice,
                                const struct model *decoded, const struct watch *watch, bp_error *error)
{
	/* A large lattice's layers one by one: their tables would take more memory than the pass is worth. */
	const uint32_t at_once = lattice_cells(head->dims) <= MEASURED_CELLS_MAX ? MEASURED_AT_ONCE : 1;
	struct expansion tables[MEASURED_AT_ONCE] = {0};
	struct fidelity figures[MEASURED_AT_ONCE];
	bp_status status = BP_OK;

	for (uint32_t l = 0; !status && l < head->layer_count; l += at_once) {
		uint32_t count = 0;
		while (!status && count < at_once && l + count < head->layer_count) {
			status = watch_tell(watch, 0.8 + 0.2 * (l + count) / head->layer_count, error);
			if (!status)
				status = layer_expand(head, record, decoded, l + count, &tables[count], error);
			count++;
		}
		if (!status)
			status = fidelity_measure_all(lattice, tables, count, figures, error);
		for (uint32_t k = 0; !status && k < count; k++)
			head->layers[l + k].fidelity = figures[k];
	}
	for (int k = 0; k < MEASURED_AT_ONCE; k++)
		expansion_free(&tables[k]);
	return status;
}

bp_status record_measure(struct record_head *head, const struct section_list *sections, const struct lattice *lattice,
                         const struct model *decoded, const struct watch *watch, uint8_t **record, size_t *record_bytes,
                         bp_error *error)
{
	uint8_t *unmeasured = NULL;
	/* Once to have the bytes that are decoded, once more with what was measured on them. */
	bp_status status = sections_join(head, sections, &unmeasured, record_bytes, error);
	const enum stage before = stage_enter(STAGE_MEASURE);
	if (!status)
		status = layers_measure(head, unmeasured, lattice, decoded, watch, error);
	free(unmeasured);
	stage_enter(before);
	return status ? status : sections_join(head, sections, record, record_bytes, error);
}
