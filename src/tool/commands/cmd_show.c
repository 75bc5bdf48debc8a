#include "tool/command.h"
#include "tool/facts.h"
#include "tool/material.h"
#include "tool/measured.h"
#include "tool/options.h"
#include "tool/output_check.h"
#include "tool/report.h"

#include "error.h"
#include "merl/merl_file.h"
#include "merl/source_kind.h"
#include "render/comparison.h"
#include "render/figure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct show_options {
	const char *output, *reference;
	bool svg, force;
	enum profile packing; /* 0: not asked for */
	struct fit_options fit;
	int slice_count;
	double theta_h[FIGURE_SLICES_MAX];
};

/* What is drawn: a measured table, a decoded one, or both, and where errors can be had, two profiles. */
struct show {
	struct material material;
	struct lattice reference;    /* of --measured */
	const struct lattice *truth; /* the reference, the material's own, or NULL */
	uint8_t *counting;           /* where there is no truth: cells that are drawn */
	struct density_source measured, decoded;
	double error_before[LATTICE_EXTENT_MAX], error_after[LATTICE_EXTENT_MAX];
	struct figure figure;
};

/* "5,20,40": 1 to 12 angles of 0 to 90 degrees. */
static bool angles_take(const struct command *command, const struct option_rule *rule, const char *text)
{
	struct show_options *options = rule->to;
	options->slice_count = 0;
	for (const char *at = text;; at++) {
		char *end;
		double value = strtod(at, &end);
		if (end == at || !(value >= 0 && value <= 90) || (*end && *end != ',') || options->slice_count == FIGURE_SLICES_MAX) {
			report_usage(command, "--theta-h: '%s' is not a list of 1 to %d angles from 0 to 90 degrees", text,
			             FIGURE_SLICES_MAX);
			return false;
		}
		options->theta_h[options->slice_count++] = value;
		at = end;
		if (!*at)
			return true;
	}
}

/* The measured file of a material in a folder: NAME.binary, or NAME.bsdf where that is what there is. malloc'ed. */
static bp_status measured_path(const char *folder, const char *name, char **out, bp_error *error)
{
	for (size_t n = 0; SOURCE_SUFFIXES[n]; n++) {
		if (asprintf(out, "%s/%s%s", folder, name, SOURCE_SUFFIXES[n]) < 0)
			return error_memory(error, strlen(folder) + strlen(name));
		if (access(*out, F_OK) == 0)
			return BP_OK;
		free(*out);
	}
	return error_set(error, BP_ERROR_NOT_FOUND, BP_NO_OFFSET, "%s: there is neither %s.binary nor %s.bsdf in it", folder, name,
	                 name);
}

/* The measured file of an archived material: the path, or that of its name in it. Another one than was packed is told. */
static bp_status reference_read(const char *path, const struct record_head *head, struct lattice *out, bp_error *error)
{
	struct stat about;
	char *file = NULL;
	bool packed;
	bp_status status = BP_OK;
	if (stat(path, &about) != 0 || !S_ISDIR(about.st_mode))
		file = strdup(path);
	else if ((status = measured_path(path, head->name, &file, error)))
		return status;
	if (!file)
		return error_memory(error, strlen(path));
	status = measured_read(&(struct source_item){.path = file}, &(struct source_cursor){NULL, NULL}, head, out, &packed, error);
	if (!status && !packed)
		report_warning(file, head->name, "not the file that was packed: its SHA-256 is another");
	free(file);
	return status;
}

/* A measured file alone: packs it in memory, as `build` would, and decodes the record. */
static bp_status material_pack(struct show *show, const struct show_options *options, bp_error *error)
{
	struct material *material = &show->material;
	struct model *model = NULL;
	const struct record_source source = {0};
	uint8_t *record = NULL;
	size_t record_bytes;
	struct holes holes;
	bp_status status = lattice_take_holes(&material->lattice, options->fit.zeros, &holes, error);
	if (status == BP_OK)
		status = record_encode(&material->lattice, material->name, &source, &options->fit, &record, &record_bytes,
		                       &material->head, error);
	if (status == BP_OK)
		status = record_decode_whole(&material->head, 0, record, &model, error);
	if (status == BP_OK)
		status = model_expand(model, 0, &material->table, error);
	model_free(model);
	free(record);
	return status;
}

/* Errors per theta_h where there is a measured table, and what the densities are taken from. */
static bp_status show_measure(struct show *show, bp_error *error)
{
	const struct material *material = &show->material;
	bp_status status;

	if (!show->truth) {
		status = material_counting_cells(&material->head, &show->counting, error);
		return status ? status : density_source_decoded(&material->table, show->counting, &show->decoded, error);
	}
	if (comparison_dims_check(show->truth->dims, material->table.dims, error))
		return BP_ERROR_BAD_INPUT;
	error_profile(show->truth, &material->table, show->error_after);
	show->figure.error_after = show->error_after;
	if (material->head.profile == PROFILE_PAPER) {
		error_profile_uncoded(show->truth, material->head.colour, show->error_before);
		show->figure.error_before = show->error_before;
	}
	if ((status = density_source_measured(show->truth, &show->measured, error)) != BP_OK)
		return status;
	return density_source_decoded(&material->table, show->truth->valid, &show->decoded, error);
}

static void figure_describe(struct show *show, const struct show_options *options)
{
	struct figure *figure = &show->figure;
	const struct material *material = &show->material;
	const char *profile = profile_name(material->head.profile);

	figure->dims = material->table.dims;
	snprintf(figure->title, sizeof figure->title, "%s, profile %s: %sdensity c(theta_d, phi_d | theta_h)", material->name,
	         profile, show->truth ? "error, and " : "");
	if (show->truth)
		figure->rows[figure->row_count++] = (struct figure_row){"measured", &show->measured};
	figure->rows[figure->row_count++] = (struct figure_row){"decoded", &show->decoded};
	figure->slice_count = options->slice_count;
	for (int s = 0; s < options->slice_count; s++) {
		const uint32_t cell = (uint32_t)(sqrt(options->theta_h[s] / 90) * figure->dims.theta_h);
		figure->slices[s] = cell < figure->dims.theta_h ? cell : figure->dims.theta_h - 1;
	}
}

static int show_draw(struct show *show, const struct show_options *options)
{
	struct material *material = &show->material;
	bp_error error;

	if (material->measured) {
		show->truth = &material->lattice;
		if (material_pack(show, options, &error))
			return report_error(material->path, NULL, &error);
	} else if (options->reference) {
		if (reference_read(options->reference, &material->head, &show->reference, &error))
			return report_error(NULL, NULL, &error); /* names the file */
		show->truth = &show->reference;
	}
	if (show_measure(show, &error))
		return report_error(material->path, material->name, &error);
	figure_describe(show, options);
	if (figure_write(options->output, options->svg, &show->figure, &error))
		return report_error(NULL, NULL, &error); /* names the output */
	return EXIT_OK;
}

/* Options that the material cannot mean. */
static int options_fit(const struct command *self, const struct show_options *options, const struct material *material)
{
	if (material->measured && options->reference)
		return report_usage(self, "--measured is about a material of an archive, '%s' is a measured file", material->path);
	if (!material->measured && options->packing)
		return report_usage(self, "--profile is about a measured file, which is packed; '%s' is an archive", material->path);
	return EXIT_OK;
}

static int show_main(const struct command *self, int argc, char **argv)
{
	struct show_options options = {
		.slice_count = 5, .theta_h = {5, 20, 40, 60, 80}, .fit = {.budget_bytes = BUDGET_USUAL, .effort = EFFORT_USUAL}};
	const struct option_rule rules[] = {
		{"output", 'o', option_text, .to = &options.output},    {"theta-h", 0, angles_take, .to = &options},
		{"measured", 0, option_text, .to = &options.reference}, {"profile", 0, option_profile, .to = &options.packing},
		{"force", 0, option_flag, .to = &options.force},        {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	if (!option_picture(self, options.output, ".svg", &options.svg))
		return EXIT_USAGE;
	options.fit.profile = options.packing ? options.packing : PROFILE_PAPER;
	const char *const inputs[2] = {optind < argc ? argv[optind] : NULL, options.reference};
	if (inputs[0] && !output_check(options.output, OUTPUT_KIND_PICTURE, options.force, inputs, 2))
		return EXIT_FAILED;
	struct show *show = calloc(1, sizeof *show);
	if (!show)
		return report_text("out of memory");
	code = material_load(self, argv + optind, argc - optind, &show->material);
	if (code == EXIT_OK)
		code = options_fit(self, &options, &show->material);
	if (code == EXIT_OK)
		code = show_draw(show, &options);
	density_source_free(&show->measured);
	density_source_free(&show->decoded);
	free(show->counting);
	lattice_free(&show->reference);
	material_free(&show->material);
	free(show);
	return code;
}

const struct command command_show = {
	.name = "show",
	.run = show_main,
	.description = "draw what the model does to a material",
	.usage = "Usage: brdfpack show [OPTION]... -o OUT.png|OUT.svg ARCHIVE NAME\n"
			 "       brdfpack show [OPTION]... -o OUT.png|OUT.svg MERL-FILE [NAME]\n"
			 "Draws the mean absolute error of every theta_h before and after coding, and the conditional pair-copula\n"
			 "densities of theta_d and phi_d for some theta_h side by side: 1 (white) everywhere means that the two are\n"
			 "independent given theta_h. Grey cells were not measured. A MERL file is packed for the purpose, as build would.\n"
			 "\n"
			 "  -o, --output=FILE    the picture to write; an older one that brdfpack drew is replaced\n"
			 "      --force          replace whatever is there\n"
			 "      --measured=PATH  the measured file of an archived material, or its folder (NAME.binary or\n"
			 "                       NAME.bsdf in it); without it only the decoded densities are drawn\n"
			 "      --theta-h=LIST   up to 12 angles in degrees (5,20,40,60,80)\n"
			 "      --profile=NAME   how a MERL file is packed: spectral or paper (paper)\n"
			 "  -h, --help           this text\n",
};
