#include "compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"

static bool figure_alike(double recorded, double measured) { return fabs(recorded - measured) <= 1e-9 * fabs(measured); }

static bp_status figures_confirm(const struct record_head *head, uint32_t layer, const struct fidelity *measured, bp_error *error)
{
	const struct fidelity *recorded = &head->layers[layer].fidelity;
	if (figure_alike(recorded->log_rmse, measured->log_rmse) &&
	    figure_alike(recorded->cube_root_rmse, measured->cube_root_rmse) &&
	    figure_alike(recorded->largest_relative, measured->largest_relative) &&
	    fabs(recorded->seen_log_rmse - measured->seen_log_rmse) <= 1e-6 * measured->seen_log_rmse /* a float in the record */)
		return BP_OK;
	return error_set(
		error, BP_ERROR_CORRUPT, BP_NO_OFFSET,
		"layer %u: the record tells errors of %.9g, %.9g, %.9g (log, cube-root, largest relative); measured: %.9g, %.9g, %.9g",
		layer, recorded->log_rmse, recorded->cube_root_rmse, recorded->largest_relative, measured->log_rmse,
		measured->cube_root_rmse, measured->largest_relative);
}

/* The layers below the last, of which `last` was measured. Uses up the table. */
static bp_status layers_confirm(const struct compare_job *job, const struct measured_item *item, const struct record_head *head,
                                const struct lattice *lattice, const struct fidelity *last, struct expansion *table,
                                bp_error *error)
{
	bp_status status = figures_confirm(head, head->layer_count - 1, last, error);
	for (uint32_t l = 0; status == BP_OK && l + 1 < head->layer_count; l++) {
		struct fidelity measured;
		status = archive_entry_expand(job->archive, &item->entry, head, l + 1, table, error);
		if (status == BP_OK)
			status = fidelity_measure(lattice, table, 1, &measured, error);
		if (status == BP_OK)
			status = figures_confirm(head, l, &measured, error);
	}
	return status;
}

bp_status compare_work(void *user, const struct job *job, int fd, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	struct compare_job *compare = user;
	const struct measured_item *item = &compare->items[job->number];
	struct compare_result result = {.record_bytes = 0};
	struct picture pictures[LIGHTING_COUNT] = {{0}};
	uint8_t *png[LIGHTING_COUNT] = {NULL};
	struct lattice lattice = {0};
	struct expansion table = {0};
	struct record_head head;
	bp_status status;

	(void)fd;
	if ((status = archive_entry_head(compare->archive, &item->entry, &head, error)) ||
	    (status = measured_read(item->source, &compare->cursor, &head, &lattice, &result.confirmed, error)) ||
	    (status = archive_entry_expand(compare->archive, &item->entry, &head, 0, &table, error)))
		goto out;
	result.record_bytes = head.record_bytes;
	status = comparison_measure(&compare->plans, &lattice, &table, &result.comparison, compare->images ? pictures : NULL, error);
	for (int l = 0; status == BP_OK && l < LIGHTING_COUNT; l++)
		if (pictures[l].rgb) {
			size_t bytes;
			status = picture_encode_png(&pictures[l], &png[l], &bytes, error);
			result.png_bytes[l] = status == BP_OK ? (uint32_t)bytes : 0;
		}
	if (status == BP_OK && result.confirmed)
		status = layers_confirm(compare, item, &head, &lattice, &result.comparison.fidelity, &table, error);
	if (status == BP_OK) {
		struct byte_buffer whole = {0};
		write_bytes(&whole, &result, sizeof result);
		for (int l = 0; l < LIGHTING_COUNT; l++)
			write_bytes(&whole, png[l], result.png_bytes[l]);
		status = workers_deliver(&whole, record, record_bytes, error);
	}
out:
	for (int l = 0; l < LIGHTING_COUNT; l++) {
		picture_free(&pictures[l]);
		free(png[l]);
	}
	lattice_free(&lattice);
	expansion_free(&table);
	return status;
}
