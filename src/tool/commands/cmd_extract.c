#include "tool/command.h"
#include "tool/facts.h"
#include "tool/folder.h"
#include "tool/options.h"
#include "tool/report.h"
#include "tool/selection.h"

#include "error.h"
#include "memory_stream.h"
#include "merl/merl_file.h"
#include "output_file.h"

#include <stdlib.h>
#include <string.h>

/* Room for one decoded table, kept from material to material as long as the lattice is the same. */
struct table {
	struct expansion expansion;
	uint8_t *below;
	double limit;     /* of `below` */
	bool any_lattice; /* also tables of more than twice as many cells as MERL's: few bytes of an archive can ask for gigabytes */
};

static void table_free(struct table *table)
{
	expansion_free(&table->expansion);
	free(table->below);
	*table = (struct table){.any_lattice = table->any_lattice};
}

static bool dims_equal(struct lattice_dims a, struct lattice_dims b)
{
	return a.theta_h == b.theta_h && a.theta_d == b.theta_d && a.phi_d == b.phi_d;
}

static bp_status table_fit(struct table *table, const struct model *model, bp_error *error)
{
	bp_status status;
	if (table->below && dims_equal(table->expansion.dims, model->dims) && table->limit == model->horizon_limit)
		return BP_OK;
	table_free(table);
	size_t cells = lattice_cells(model->dims);
	status = expansion_alloc(model->dims, &table->expansion, error);
	if (status)
		return status;
	table->below = malloc(cells);
	status =
		table->below ? lattice_below_horizon(model->dims, model->horizon_limit, table->below, error) : error_memory(error, cells);
	table->limit = model->horizon_limit;
	if (status)
		table_free(table);
	return status;
}

/* What to write: a decoded table with its record, the table alone, or the parameters. */
enum form { FORM_MERL, FORM_PLAIN, FORM_JSON };

/* The record to carry: NULL where it is damaged, but not in anything that this program decodes, which it has done. */
static bp_status record_read(const struct selection *selection, const struct index_entry *entry, uint8_t **record,
                             bp_error *error)
{
	struct record_head head;
	const bp_status status = archive_entry_record(selection->archive, entry, &head, record, error);
	return status == BP_ERROR_CHECKSUM ? BP_OK : status;
}

static bp_status merl_write(const struct selection *selection, const struct index_entry *entry, const struct record_head *head,
                            const char *path, enum output_rule rule, bool plain, struct table *table, bp_error *error)
{
	struct model *model = NULL;
	uint8_t *record = NULL;
	if (!table->any_lattice && lattice_cells(head->dims) > 2 * lattice_cells(LATTICE_MERL))
		return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET,
		                 "a table of %u x %u x %u cells would take %.0f MB; with --any-lattice it is written", head->dims.theta_h,
		                 head->dims.theta_d, head->dims.phi_d, (double)merl_file_bytes(head->dims) / 1e6);
	bp_status status = archive_entry_load(selection->archive, entry, head, 0, &model, error);
	if (!status && !plain)
		status = record_read(selection, entry, &record, error);
	if (!status)
		status = table_fit(table, model, error);
	if (!status)
		status = model_expand(model, 0, &table->expansion, error);
	if (!status)
		status = lattice_write_path(path, rule, &table->expansion, table->below, record, record ? head->record_bytes : 0, error);
	model_free(model);
	free(record);
	return status;
}

static bp_status json_write(const struct record_head *head, const struct origin *origin, const char *path, enum output_rule rule,
                            bp_error *error)
{
	struct output_file file;
	struct byte_buffer text = {0};
	bp_status status;

	FILE *memory = memory_stream_open(&text);
	if (!memory)
		return error_memory(error, BUFSIZ);
	struct json json = json_begin(memory, true);
	json_object(&json, NULL);
	json_string(&json, "name", head->name);
	facts_full(&json, head, origin);
	json_close(&json);
	json_finish(&json);
	fclose(memory);
	status = text.failed ? error_memory(error, text.count) : output_file_open(path, rule, &file, error);
	if (!status) {
		status = output_file_write(&file, text.bytes, text.count, error);
		if (!status)
			status = output_file_commit(&file, error);
		else
			output_file_discard(&file);
	}
	byte_buffer_free(&text);
	return status;
}

struct extraction {
	struct selection selection;
	enum form form;
	struct table table;
	struct index_entry entry; /* of the material that was asked for last */
};

/* Names hold no '/', so a file cannot land in another folder. */
static const char *material_name(void *user, uint64_t n)
{
	struct extraction *extraction = user;
	extraction->entry = (struct index_entry){.name = ""};
	return selection_entry(&extraction->selection, n, &extraction->entry, NULL) ? NULL : extraction->entry.name;
}

static bp_status material_write(void *user, uint64_t n, const char *path, enum output_rule rule, bp_error *error)
{
	struct extraction *extraction = user;
	struct selection *selection = &extraction->selection;
	struct record_head head;
	extraction->entry = (struct index_entry){.name = ""};
	bp_status status = selection_entry(selection, n, &extraction->entry, error);
	if (!status)
		status = archive_entry_head(selection->archive, &extraction->entry, &head, error);
	if (status)
		return status;
	if (extraction->form == FORM_JSON) {
		struct origin origin;
		status = archive_entry_origin(selection->archive, &extraction->entry, &head, &origin, error);
		return status ? status : json_write(&head, &origin, path, rule, error);
	}
	return merl_write(selection, &extraction->entry, &head, path, rule, extraction->form == FORM_PLAIN, &extraction->table,
	                  error);
}

static void material_failed(void *user, uint64_t n, const bp_error *error)
{
	const struct extraction *extraction = user;
	(void)n;
	report_error(extraction->selection.path, extraction->entry.name[0] ? extraction->entry.name : NULL, error);
}

static int extract_main(const struct command *self, int argc, char **argv)
{
	enum { OPTION_FORMAT = OPTION_LONG, OPTION_PLAIN, OPTION_FORCE, OPTION_ANY_LATTICE };
	static const struct option names[] = {{"directory", required_argument, NULL, 'C'},
	                                      {"format", required_argument, NULL, OPTION_FORMAT},
	                                      {"plain", no_argument, NULL, OPTION_PLAIN},
	                                      {"force", no_argument, NULL, OPTION_FORCE},
	                                      {"any-lattice", no_argument, NULL, OPTION_ANY_LATTICE},
	                                      {0}};
	const char *folder = ".";
	struct extraction extraction = {.form = FORM_MERL};
	bool json = false, plain = false, force = false;
	int option;

	while ((option = options_next(self, argc, argv, "C:", names)) >= 0) {
		if (option == 'C')
			folder = optarg;
		else if (option == OPTION_PLAIN)
			plain = true;
		else if (option == OPTION_FORCE)
			force = true;
		else if (option == OPTION_ANY_LATTICE)
			extraction.table.any_lattice = true;
		else if (!strcmp(optarg, "json") || !strcmp(optarg, "merl"))
			json = optarg[0] == 'j';
		else
			return report_usage(self, "--format: '%s' is neither 'merl' nor 'json'", optarg);
	}
	if (option != OPTIONS_END)
		return options_exit_code(option);
	if (json && plain)
		return report_usage(self, "--plain is about MERL files, --format json writes none");
	int opened = selection_from(&extraction.selection, self, argv + optind, argc - optind);
	if (opened != EXIT_OK)
		return opened;
	extraction.form = json ? FORM_JSON : plain ? FORM_PLAIN : FORM_MERL;
	const struct folder_set set = {.folder = folder,
	                               .suffix = json ? "json" : "binary",
	                               .count = extraction.selection.count,
	                               .force = force,
	                               .user = &extraction,
	                               .name = material_name,
	                               .write = material_write,
	                               .failed = material_failed};
	bool whole = folder_write(&set) && !extraction.selection.incomplete;
	table_free(&extraction.table);
	selection_close(&extraction.selection);
	return whole ? EXIT_OK : EXIT_FAILED;
}

const struct command command_extract = {
	.name = "extract",
	.run = extract_main,
	.description = "write materials as MERL files, or their parameters as JSON",
	.usage = "Usage: brdfpack extract [-C DIR] [OPTION]... ARCHIVE [NAME]...\n"
			 "Writes DIR/NAME.binary for the named materials, or for all. When a file of one of these names\n"
			 "is there and differs, nothing is written. Cells wholly below the horizon\n"
			 "are negative, all others hold the model's value. The negative ones carry the material's\n"
			 "record, which a build with the same profile and a budget that holds it takes over as it\n"
			 "is, unless a value was changed.\n"
			 "\n"
			 "  -C, --directory DIR  where to (default: here); created when it is missing\n"
			 "      --format merl    MERL files (the default)\n"
			 "      --format json    DIR/NAME.json with the parameters instead\n"
			 "      --force          replace files that are there\n"
			 "      --any-lattice    also tables of more than twice as many cells as MERL's\n"
			 "      --plain          no record: every cell below the horizon is -1\n"
			 "  -h, --help           this text\n",
};
