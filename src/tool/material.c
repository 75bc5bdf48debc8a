#include "material.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "merl/merl_file.h"
#include "merl/source_kind.h"
#include "report.h"
#include "selection.h"

static int archived_load(struct material *material, char *name)
{
	struct selection selection;
	struct index_entry entry = {.name = ""};
	bp_error error;
	int code = EXIT_OK;

	if (!selection_open(&selection, material->path, &name, 1))
		return EXIT_FAILED;
	if (selection.incomplete)
		code = EXIT_FAILED; /* reported */
	else if (selection_entry(&selection, 0, &entry, &error) ||
	         archive_entry_head(selection.archive, &entry, &material->head, &error) ||
	         archive_entry_expand(selection.archive, &entry, &material->head, 0, &material->table, &error))
		code = report_error(material->path, name, &error);
	else
		memcpy(material->name, material->head.name, sizeof material->name);
	selection_close(&selection);
	return code;
}

static int measured_load(struct material *material, const char *name)
{
	char stem[SOURCE_STEM_BYTES];
	bp_error error;
	if (lattice_read_path(material->path, &(struct merl_reading){.any_dims = true}, &material->lattice, &error))
		return report_error(material->path, NULL, &error);
	source_stem(material->path, stem);
	name = name ? name : stem;
	size_t bytes = strnlen(name, sizeof material->name - 1);
	memcpy(material->name, name, bytes);
	material->name[bytes] = '\0';
	material->measured = true;
	return EXIT_OK;
}

int material_load(const struct command *command, char **operands, int operand_count, struct material *material)
{
	bp_archive *archive;
	bp_error error;

	*material = (struct material){.path = operand_count > 0 ? operands[0] : NULL};
	if (operand_count < 1)
		return report_usage(command, "no archive or MERL file");
	if (operand_count > 2)
		return report_usage(command, "one material at a time: '%s' is too much", operands[2]);
	/* what it is, the archive reader knows; anything that is not an archive is read as a MERL file */
	bp_status status = bp_archive_open(material->path, &archive, &error);
	int code;
	if (status == BP_OK) {
		bp_archive_close(archive);
		if (operand_count < 2)
			return report_usage(command, "%s is an archive: which material? `brdfpack list` shows the names", material->path);
		code = archived_load(material, operands[1]);
	} else if (status == BP_ERROR_NOT_OURS) {
		code = measured_load(material, operand_count > 1 ? operands[1] : NULL);
	} else {
		code = report_error(material->path, NULL, &error);
	}
	if (code != EXIT_OK)
		material_free(material);
	return code;
}

void material_free(struct material *material)
{
	lattice_free(&material->lattice);
	expansion_free(&material->table);
	*material = (struct material){0};
}

bp_status material_counting_cells(const struct record_head *head, uint8_t **valid, bp_error *error)
{
	size_t cells = lattice_cells(head->dims);
	uint8_t *mask = malloc(cells);
	if (!mask)
		return error_memory(error, cells);
	lattice_below_horizon(head->dims, head->horizon_limit, mask);
	for (size_t n = 0; n < cells; n++)
		mask[n] = !mask[n];
	*valid = mask;
	return BP_OK;
}

bp_status material_lookup(const struct record_head *head, const struct expansion *decoded, struct lookup_table *out,
                          bp_error *error)
{
	uint8_t *valid = NULL;
	bp_status status = material_counting_cells(head, &valid, error);
	if (status != BP_OK)
		return status;
	status = lookup_table_decoded(decoded, valid, 0, out, error);
	free(valid);
	return status;
}
