#include "tool/command.h"
#include "tool/folder.h"
#include "tool/options.h"
#include "tool/report.h"

#include "merl/demo.h"
#include "merl/merl_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "HxDxP", each a whole number. */
static bool lattice_take(const struct command *self, const struct option_rule *rule, const char *text)
{
	struct lattice_dims *dims = rule->to;
	int end = 0;
	if (strspn(text, "0123456789x") == strlen(text) &&
	    sscanf(text, "%4ux%4ux%4u%n", &dims->theta_h, &dims->theta_d, &dims->phi_d, &end) == 3 && !text[end] &&
	    lattice_dims_legal(*dims))
		return true;
	report_usage(self, "--lattice: '%s' is not HxDxP with 4 to %d cells each, at most %d in all", text, LATTICE_EXTENT_MAX,
	             LATTICE_CELLS_MAX);
	return false;
}

struct synthesis {
	struct lattice_dims dims;
	bool clean;
	const char *folder;
};

static const char *material_name(void *user, uint64_t n)
{
	(void)user;
	return demo_name((size_t)n);
}

static bp_status material_write(void *user, uint64_t n, const char *path, enum output_rule rule, bp_error *error)
{
	const struct synthesis *synthesis = user;
	struct lattice lattice = {0};
	bp_status status = demo_generate((size_t)n, synthesis->dims, synthesis->clean, &lattice, error);
	if (!status)
		status = lattice_save_path(path, rule, &lattice, error);
	lattice_free(&lattice);
	return status;
}

static void material_failed(void *user, uint64_t n, const bp_error *error)
{
	const struct synthesis *synthesis = user;
	report_error(synthesis->folder, demo_name((size_t)n), error);
}

static int synth_main(const struct command *self, int argc, char **argv)
{
	struct synthesis synthesis = {.dims = LATTICE_MERL};
	bool force = false;
	const struct option_rule rules[] = {{"clean", 0, option_flag, .to = &synthesis.clean},
	                                    {"lattice", 0, lattice_take, .to = &synthesis.dims},
	                                    {"force", 0, option_flag, .to = &force},
	                                    {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	if (argc - optind != 1)
		return report_usage(self, argc == optind ? "no folder" : "more than one folder");
	synthesis.folder = argv[optind];
	const struct folder_set set = {.folder = synthesis.folder,
	                               .suffix = "binary",
	                               .count = demo_count(),
	                               .force = force,
	                               .user = &synthesis,
	                               .name = material_name,
	                               .write = material_write,
	                               .failed = material_failed};
	return folder_write(&set) ? EXIT_OK : EXIT_FAILED;
}

const struct command command_synth = {
	.name = "synth",
	.run = synth_main,
	.description = "write the demo materials as MERL files",
	.usage = "Usage: brdfpack synth [--clean] [--force] DIR\n"
			 "Writes analytic materials of every kind as MERL files (35 MB each) into DIR, which is created\n"
			 "when it is missing: with noise and unmeasured cells like a measurement's. When a file\n"
			 "of one of their names is there and differs, nothing is written.\n"
			 "\n"
			 "      --clean          without noise and faults\n"
			 "      --force          replace files that are there\n"
			 "      --lattice HxDxP  other extents than MERL's 90x90x180 (for tests)\n"
			 "  -h, --help           this text\n",
};
