#include "record_carried.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "merl/merl_file.h"
#include "stage.h"
#include "name.h"

/* What can be told from its head alone. */
static bool head_serves(const struct record_head *head, const struct lattice *lattice, size_t carried_bytes, size_t name_bytes,
                        const struct fit_options *options)
{
	const uint64_t bytes = head->record_bytes - strlen(head->name) + name_bytes;
	const bool bounded = options->max_error > 0;
	return head->record_bytes == carried_bytes && head->profile == options->profile &&
	       lattice_dims_equal(head->dims, lattice->dims) && bytes <= (bounded ? RECORD_BUDGET_MAX : options->budget_bytes) &&
	       (!bounded || head->options.max_error == options->max_error);
}

/* Is the lattice what the model decodes to? */
static bp_status model_compare(const struct lattice *lattice, const struct model *model, bool *same, bp_error *error)
{
	struct expansion table = {0};
	uint8_t *below = malloc(lattice_cells(lattice->dims));
	bp_status status = below ? model_expand(model, 0, &table, error) : error_memory(error, lattice_cells(lattice->dims));
	if (!status) {
		lattice_below_horizon(lattice->dims, model->horizon_limit, below);
		*same = lattice_is_written(lattice, &table, below);
	}
	expansion_free(&table);
	free(below);
	return status;
}

/* Decodes every layer, as whoever loads the record may ask for any, and compares the last. */
static bp_status record_compare(const struct lattice *lattice, const uint8_t *record, const struct record_head *head, bool *same,
                                bp_error *error)
{
	bp_status status = BP_OK;
	for (uint32_t layers = 1; layers <= head->layer_count && !status; layers++) {
		struct model *model = NULL;
		status = record_decode_whole(head, layers, record, &model, error);
		if (!status && layers == head->layer_count)
			status = model_compare(lattice, model, same, error);
		model_free(model);
	}
	return status;
}

bp_status record_carried(const struct lattice *lattice, const struct carried *carried, const char *name,
                         const struct fit_options *options, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	const size_t name_bytes = strlen(name);
	struct record_head head;
	bool same = false;

	*record = NULL;
	if (!carried->bytes || name_fault(name, name_bytes) ||
	    record_head_read(carried->bytes, carried->count, &head, NULL) != BP_OK ||
	    !head_serves(&head, lattice, carried->count, name_bytes, options))
		return BP_OK;
	const enum stage before = stage_enter(STAGE_CODE);
	bp_status status = record_compare(lattice, carried->bytes, &head, &same, error);
	if (!status && same)
		status = record_rename(carried->bytes, carried->count, name, record, record_bytes, error);
	stage_enter(before);
	return status == BP_ERROR_MEMORY ? status : BP_OK; /* any other says that there is no record to keep */
}
