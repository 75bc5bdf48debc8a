#include "tool/command.h"
#include "tool/export/export.h"
#include "tool/facts.h"
#include "tool/folder.h"
#include "tool/options.h"
#include "tool/report.h"
#include "tool/selection.h"

#include "error.h"
#include "memory_stream.h"
#include "merl/merl_file.h"
#include "merl/spelling.h"
#include "output_file.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Room for one decoded table, kept from material to material as long as the lattice is the same. */
struct decoded_room {
	struct expansion expansion;
	uint8_t *below;
	double limit;     /* of `below` */
	bool any_lattice; /* also tables of more than twice as many cells as MERL's: few bytes of an archive can ask for gigabytes */
};

static void room_free(struct decoded_room *room)
{
	expansion_free(&room->expansion);
	free(room->below);
	*room = (struct decoded_room){.any_lattice = room->any_lattice};
}

/* For a table of that record; decoding allocates it where there is none. */
static bp_status room_fit(struct decoded_room *room, const struct record_head *head, bp_error *error)
{
	if (room->below && lattice_dims_equal(room->expansion.dims, head->dims) && room->limit == head->horizon_limit)
		return BP_OK;
	room_free(room);
	room->below = malloc(lattice_cells(head->dims));
	if (!room->below)
		return error_memory(error, lattice_cells(head->dims));
	lattice_below_horizon(head->dims, head->horizon_limit, room->below);
	room->limit = head->horizon_limit;
	return BP_OK;
}

/* What to write: a decoded table, the parameters, or a renderer's file. */
enum form { FORM_MERL, FORM_JSON, FORM_EXPORT };

/* What --format is called by, and the suffix of its files. */
static const struct format {
	const char *name, *suffix;
	enum form form;
	enum export_format export; /* FORM_EXPORT */
} FORMATS[] = {
	{"merl", "binary", FORM_MERL, 0},
	{"json", "json", FORM_JSON, 0},
	{"bsdf", "bsdf", FORM_EXPORT, EXPORT_BSDF},
	{"mbsdf", "mbsdf", FORM_EXPORT, EXPORT_MBSDF},
};
enum { FORMAT_COUNT = sizeof FORMATS / sizeof *FORMATS };

/* Below so many dB a renderer's file that is as large as it may be is told to be poor. */
static const double EXPORT_POOR = 40;

/* The record to carry: NULL where it is damaged, but not in anything that this program decodes, which it has done. */
static bp_status record_read(const struct selection *selection, const struct index_entry *entry, uint8_t **record,
                             bp_error *error)
{
	struct record_head head;
	const bp_status status = archive_entry_record(selection->archive, entry, &head, record, error);
	return status == BP_ERROR_CHECKSUM ? BP_OK : status;
}

static bp_status merl_write(const struct selection *selection, const struct index_entry *entry, const struct record_head *head,
                            const char *path, enum output_rule rule, bool plain, struct decoded_room *room, bp_error *error)
{
	uint8_t *record = NULL;
	bp_status status = room_fit(room, head, error);
	if (!status)
		status = archive_entry_expand(selection->archive, entry, head, 0, &room->expansion, error);
	if (!status && !plain)
		status = record_read(selection, entry, &record, error);
	if (!status)
		status = lattice_write_path(path, rule, &room->expansion, room->below, record, record ? head->record_bytes : 0, error);
	free(record);
	return status;
}

static bp_status lattice_size_check(const struct record_head *head, bool any_lattice, bp_error *error)
{
	if (any_lattice || lattice_cells(head->dims) <= 2 * lattice_cells(LATTICE_MERL))
		return BP_OK;
	return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET,
	                 "a table of %u x %u x %u cells would take %.0f MB; with --any-lattice it is written", head->dims.theta_h,
	                 head->dims.theta_d, head->dims.phi_d, (double)merl_file_bytes(head->dims) / 1e6);
}

static bp_status export_write(const struct selection *selection, const struct index_entry *entry, const struct record_head *head,
                              const char *path, enum output_rule rule, const struct export_options *options, bp_error *error)
{
	struct model *model = NULL;
	struct byte_buffer bytes = {0};
	struct deviation deviation;
	bp_status status = archive_entry_load(selection->archive, entry, head, 0, &model, error);
	if (!status)
		status = export_material(model, head->name, options, &bytes, &deviation, error);
	if (!status)
		status = output_file_write_whole(path, rule, bytes.bytes, bytes.count, error);
	if (!status && deviation.psnr < EXPORT_POOR && rule != OUTPUT_COMPARE)
		report_warning(path, NULL, "in %zu bytes it is %.1f dB from the material; a larger --size brings it nearer", bytes.count,
		               deviation.psnr);
	byte_buffer_free(&bytes);
	model_free(model);
	return status;
}

static bp_status json_write(const struct record_head *head, const struct origin *origin, const char *path, enum output_rule rule,
                            bp_error *error)
{
	struct byte_buffer text = {0};

	FILE *memory = memory_stream_open(&text);
	if (!memory)
		return error_memory(error, BUFSIZ);
	facts_print(memory, true, head, origin);
	fclose(memory);
	bp_status status =
		text.failed ? error_memory(error, text.count) : output_file_write_whole(path, rule, text.bytes, text.count, error);
	byte_buffer_free(&text);
	return status;
}

struct extraction {
	struct selection selection;
	const struct format *format;
	bool plain;                   /* FORM_MERL without the record */
	struct export_options export; /* FORM_EXPORT */
	struct decoded_room room;
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
	if (extraction->format->form == FORM_JSON) {
		struct origin origin;
		status = archive_entry_origin(selection->archive, &extraction->entry, &head, &origin, error);
		return status ? status : json_write(&head, &origin, path, rule, error);
	}
	status = lattice_size_check(&head, extraction->room.any_lattice, error);
	if (status)
		return status;
	if (extraction->format->form == FORM_EXPORT)
		return export_write(selection, &extraction->entry, &head, path, rule, &extraction->export, error);
	return merl_write(selection, &extraction->entry, &head, path, rule, extraction->plain, &extraction->room, error);
}

static void material_failed(void *user, uint64_t n, const bp_error *error)
{
	const struct extraction *extraction = user;
	(void)n;
	report_error(extraction->selection.path, extraction->entry.name[0] ? extraction->entry.name : NULL, error);
}

static bool format_take(const struct command *self, const struct option_rule *rule, const char *text)
{
	struct name_guess guess;
	name_guess_start(&guess, text);
	for (int n = 0; n < FORMAT_COUNT; n++) {
		if (!strcmp(FORMATS[n].name, text)) {
			*(const struct format **)rule->to = &FORMATS[n];
			return true;
		}
		name_guess_offer(&guess, FORMATS[n].name);
	}
	const char *best = name_guess_best(&guess);
	report_usage(self, "--format: '%s' is none of merl, json, bsdf and mbsdf%s%s%s", text, best ? "; did you mean '" : "",
	             best ? best : "", best ? "'?" : "");
	return false;
}

/* What belongs together on the command line; `size` 0: not given. Fills what is exported; an exit code. */
static int export_take(const struct command *self, struct extraction *extraction, int64_t size)
{
	const struct format *format = extraction->format;
	const bool exports = format->form == FORM_EXPORT, spectral = extraction->export.spectral;
	const uint64_t least = exports ? export_bytes_least(format->export, spectral) : 0;
	const uint64_t usual = exports ? export_bytes_usual(format->export, spectral) : 0;
	const uint64_t most = size ? (uint64_t)size : usual;
	if (extraction->plain && format->form != FORM_MERL)
		return report_usage(self, "--plain is about MERL files, --format %s writes none", format->name);
	if (spectral && !(exports && format->export == EXPORT_BSDF))
		return report_usage(self, "--spectral is about --format bsdf");
	if (size && !exports)
		return report_usage(self, "--size is about --format bsdf and --format mbsdf");
	if (exports && most < least)
		return report_usage(
			self, "--size: %" PRIu64 " bytes are too few for --format %s%s; %" PRIu64 " are enough for its smallest file", most,
			format->name, spectral ? " --spectral" : "", least);
	extraction->export = (struct export_options){format->export, spectral, most};
	return EXIT_OK;
}

static int extract_main(const struct command *self, int argc, char **argv)
{
	struct extraction extraction = {.format = FORMATS};
	const char *folder = ".";
	int64_t size = 0;
	bool force = false;
	const struct option_rule rules[] = {{"directory", 'C', option_text, .to = &folder},
	                                    {"format", 0, format_take, .to = &extraction.format},
	                                    {"plain", 0, option_flag, .to = &extraction.plain},
	                                    {"force", 0, option_flag, .to = &force},
	                                    {"any-lattice", 0, option_flag, .to = &extraction.room.any_lattice},
	                                    {"spectral", 0, option_flag, .to = &extraction.export.spectral},
	                                    {"size", 0, option_bytes, &size, 1, EXPORT_BYTES_MAX},
	                                    {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	code = export_take(self, &extraction, size);
	if (code == EXIT_OK)
		code = selection_from(&extraction.selection, self, argv + optind, argc - optind);
	if (code != EXIT_OK)
		return code;
	const struct folder_set set = {.folder = folder,
	                               .suffix = extraction.format->suffix,
	                               .count = extraction.selection.count,
	                               .force = force,
	                               .user = &extraction,
	                               .name = material_name,
	                               .write = material_write,
	                               .failed = material_failed};
	bool whole = folder_write(&set) && !extraction.selection.incomplete;
	room_free(&extraction.room);
	selection_close(&extraction.selection);
	return whole ? EXIT_OK : EXIT_FAILED;
}

const struct command command_extract = {
	.name = "extract",
	.run = extract_main,
	.description = "write materials as MERL or renderers' files, or as JSON",
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
			 "      --format bsdf    DIR/NAME.bsdf for `measured` of Mitsuba 3 and what else reads the RGL database\n"
			 "      --format mbsdf   DIR/NAME.mbsdf, a measured BSDF for renderers with NVIDIA's MDL\n"
			 "      --spectral       bsdf: with a smooth spectrum instead of RGB, for pbrt-v4 and spectral Mitsuba\n"
			 "      --size BYTES     bsdf, mbsdf: the largest file (2M; --spectral 8M; mbsdf 20M). It is the smallest\n"
			 "                       with spheres 52 dB from the material's, or the best that fits\n"
			 "      --force          replace files that are there\n"
			 "      --any-lattice    also tables of more than twice as many cells as MERL's\n"
			 "      --plain          no record: every cell below the horizon is -1\n"
			 "  -h, --help           this text\n",
};
