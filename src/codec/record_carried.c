#include "record_carried.h"

#include <stdlib.h>
#include <string.h>

#include "../merl/merl_file.h"
#include "../stage.h"
#include "name.h"
#include "profile_codec.h"
#include "record_measure.h"

/* What can be told from its head alone. */
static bool head_serves(const struct record_head *head, const struct lattice *lattice, size_t name_bytes, const struct fit_options *options)
{
	const uint64_t bytes = head->record_bytes - strlen(head->name) + name_bytes;
	return head->record_bytes == lattice->carried_bytes && head->profile == options->profile && profile_codec_find(head->profile) &&
	       !memcmp(&head->dims, &lattice->dims, sizeof head->dims) &&
	       (options->max_error > 0 ? head->options.max_error == options->max_error : bytes <= options->budget_bytes);
}

/* The model behind the carried record, or NULL where that is not exactly what the lattice holds. A failure only says that there is no record. */
static struct model *model_behind(const struct lattice *lattice, const struct record_head *head)
{
	struct model *model = NULL;
	struct expansion table = {0};
	uint8_t *below = malloc(lattice_cells(lattice->dims));
	const bool same = below && record_decode_whole(head, 0, lattice->carried, &model, NULL) == BP_OK &&
	                  expansion_alloc(lattice->dims, &table, NULL) == BP_OK && model_expand(model, 0, &table, NULL) == BP_OK &&
	                  lattice_below_horizon(lattice->dims, head->horizon_limit, below, NULL) == BP_OK &&
	                  lattice_is_written(lattice, &table, below);
	expansion_free(&table);
	free(below);
	if (same)
		return model;
	model_free(model);
	return NULL;
}

bp_status record_carried(const struct lattice *lattice, const char *name, const struct record_source *source,
                         const struct fit_options *options, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	const size_t name_bytes = strlen(name);
	struct section_list sections = {0};
	struct record_head head;
	bp_status status = BP_OK;

	*record = NULL;
	if (!lattice->carried || name_fault(name, name_bytes) || record_head_parse(lattice->carried, lattice->carried_bytes, &head, NULL) != BP_OK ||
	    !head_serves(&head, lattice, name_bytes, options))
		return BP_OK;
	const enum stage before = stage_enter(STAGE_MEASURE);
	struct model *model = model_behind(lattice, &head);
	if (model && record_sections(lattice->carried, &head, head.layer_count, &sections, NULL) == BP_OK) {
		memset(head.name, 0, sizeof head.name);
		memcpy(head.name, name, name_bytes);
		head.source = *source;
		head.options = *options;
		status = record_measure(&head, &sections, lattice, model, record, record_bytes, error);
	}
	section_list_free(&sections);
	model_free(model);
	stage_enter(before);
	return status;
}
