#include "compare.h"

#include <stdlib.h>
#include <string.h>

#include "../error.h"

/* Head, figures and PNG files in one malloc'ed block. */
static bp_status result_pack(const struct compare_result *result, uint8_t *const png[LIGHTING_COUNT], uint8_t **out,
                             size_t *out_bytes, bp_error *error)
{
	size_t bytes = sizeof *result, at = sizeof *result;
	for (int l = 0; l < LIGHTING_COUNT; l++)
		bytes += result->png_bytes[l];
	uint8_t *block = malloc(bytes);
	if (!block)
		return error_memory(error, bytes);
	memcpy(block, result, sizeof *result);
	for (int l = 0; l < LIGHTING_COUNT; l++)
		if (result->png_bytes[l]) {
			memcpy(block + at, png[l], result->png_bytes[l]);
			at += result->png_bytes[l];
		}
	*out = block;
	*out_bytes = bytes;
	return BP_OK;
}

static bp_status decoded_load(const struct compare_job *job, const struct compare_item *item, struct expansion *table,
                              struct record_head *head, bp_error *error)
{
	struct model *model;
	bp_status status = archive_entry_head(job->archive, &item->entry, head, error);
	if (status != BP_OK)
		return status;
	if ((status = archive_entry_load(job->archive, &item->entry, head, 0, &model, error)) != BP_OK)
		return status;
	status = expansion_alloc(head->dims, table, error);
	if (status == BP_OK)
		status = model_expand(model, 0, table, error);
	model_free(model);
	return status;
}

bp_status compare_work(void *user, const struct job *job, int fd, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	struct compare_job *compare = user;
	const struct compare_item *item = &compare->items[job->number];
	struct compare_result result = {.record_bytes = 0};
	struct picture pictures[LIGHTING_COUNT] = {{0}};
	uint8_t *png[LIGHTING_COUNT] = {NULL};
	struct lattice lattice = {0};
	struct expansion table = {0};
	struct record_head head;
	bp_error reason;
	bp_status status;

	(void)fd;
	status = source_item_read(item->source, &compare->cursor, NULL, NULL, &lattice, &reason);
	if (status != BP_OK) {
		error_set(error, status, BP_NO_OFFSET, "%s: %s", item->source->path, reason.message);
		goto out;
	}
	if ((status = decoded_load(compare, item, &table, &head, error)) != BP_OK)
		goto out;
	result.record_bytes = head.record_bytes;
	status = comparison_measure(&compare->plans, &lattice, &table, &result.comparison, compare->images ? pictures : NULL, error);
	for (int l = 0; status == BP_OK && l < LIGHTING_COUNT; l++)
		if (pictures[l].rgb) {
			size_t bytes;
			status = picture_encode_png(&pictures[l], &png[l], &bytes, error);
			result.png_bytes[l] = status == BP_OK ? (uint32_t)bytes : 0;
		}
	if (status == BP_OK)
		status = result_pack(&result, png, record, record_bytes, error);
out:
	for (int l = 0; l < LIGHTING_COUNT; l++) {
		picture_free(&pictures[l]);
		free(png[l]);
	}
	lattice_free(&lattice);
	expansion_free(&table);
	return status;
}
