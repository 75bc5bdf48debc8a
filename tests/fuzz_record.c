/*
 * The record decoder on arbitrary bytes with mended checksums: head, sections of every layer, expansion; and the record carried by
 * the very table that it decodes to, as by a file that was extracted: what a build keeps of it must decode, layer by layer.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "archive_walk.h"
#include "codec/record_carried.h"
#include "merl/merl_file.h"

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

/* The lattice that extraction of this record and reading gives; false where there is none. */
static bool lattice_extracted(const struct record_head *head, const uint8_t *record, struct lattice *out)
{
	const size_t cells = lattice_cells(head->dims);
	struct expansion table = {0};
	struct model *model = NULL;
	uint8_t *below = malloc(cells);
	bool made = record_decode_whole(head, 0, record, &model, NULL) == BP_OK &&
	            expansion_alloc(head->dims, &table, NULL) == BP_OK && model_expand(model, 0, &table, NULL) == BP_OK &&
	            lattice_alloc(head->dims, out, NULL) == BP_OK;
	if (made)
		lattice_below_horizon(head->dims, head->horizon_limit, below);
	for (int c = 0; made && c < 3; c++) {
		for (size_t i = 0; i < cells; i++) {
			const double value = table.unit * (double)table.rgb[c][i] / MERL_SCALE[c];
			out->rgb[c][i] = below[i] ? -1 : value <= DBL_MAX ? value : DBL_MAX;
		}
		lattice_scan(out->rgb[c], cells, MERL_SCALE[c], out->valid);
	}
	if (made)
		lattice_scan_finish(out);
	if (made && out->valid_count == 0) { /* reading refuses it */
		lattice_free(out);
		made = false;
	}
	expansion_free(&table);
	model_free(model);
	free(below);
	return made;
}

static void carried_check(const struct lattice *lattice, const struct carried *carried, const struct fit_options *options)
{
	struct record_head head;
	uint8_t *record;
	size_t bytes;
	if (record_carried(lattice, carried, "m", options, &record, &bytes, NULL) != BP_OK || !record)
		return;
	if (record_head_read(record, bytes, &head, NULL) != BP_OK || head.record_bytes != bytes)
		abort();
	for (uint32_t layers = 1; layers <= head.layer_count; layers++) {
		struct model *model;
		if (record_decode_whole(&head, layers, record, &model, NULL) != BP_OK)
			abort();
		model_free(model);
	}
	free(record);
}

/* By the budget, and by the bound on the error that it was made for. */
static void record_carry(const struct record_head *head, const uint8_t *record)
{
	const double bounds[2] = {0, head->options.max_error};
	struct lattice lattice;
	if (!lattice_extracted(head, record, &lattice))
		return;
	struct carried carried = {malloc(head->record_bytes), head->record_bytes};
	memcpy(carried.bytes, record, head->record_bytes);
	for (int n = 0; n < (bounds[1] > 0 ? 2 : 1); n++) {
		const struct fit_options options = {head->profile, RECORD_BUDGET_MAX, bounds[n], 5};
		carried_check(&lattice, &carried, &options);
	}
	lattice_free(&lattice);
	free(carried.bytes);
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
	if (record_head_read(copy, count, &head, NULL) == BP_OK && lattice_cells(head.dims) <= WALK_CELLS_MAX) {
		layers_decode(&head, &input, 1);
		layers_decode(&head, &input, 0);
		if (record_keep_layers(copy, count, 1, &kept, &kept_bytes, NULL) == BP_OK)
			free(kept);
		if (head.record_bytes <= count)
			record_carry(&head, copy);
	}
	free(copy);
	return 0;
}
