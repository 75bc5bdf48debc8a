#include "tool/command.h"
#include "tool/folder.h"
#include "tool/options.h"
#include "tool/report.h"

#include "error.h"
#include "merl/demo.h"
#include "merl/merl_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "HxDxP", each a whole number. */
static bool lattice_parse(const char *text, struct lattice_dims *dims)
{
	int end = 0;
	if (strspn(text, "0123456789x") != strlen(text) ||
	    sscanf(text, "%4ux%4ux%4u%n", &dims->theta_h, &dims->theta_d, &dims->phi_d, &end) != 3 || text[end])
		return false;
	return lattice_dims_legal(*dims);
}

static bool material_write(size_t index, struct lattice_dims dims, bool clean, const char *folder)
{
	struct lattice lattice = {0};
	bp_error error;
	char *path = folder_path(folder, demo_name(index), "binary");
	bp_status status = path ? demo_generate(index, dims, clean, &lattice, &error) : error_memory(&error, 0);
	if (!status)
		status = lattice_save_path(path, &lattice, &error);
	if (status)
		report_error(folder, demo_name(index), &error);
	lattice_free(&lattice);
	free(path);
	return !status;
}

static int synth_main(const struct command *self, int argc, char **argv)
{
	enum { OPTION_CLEAN = OPTION_LONG, OPTION_LATTICE };
	static const struct option names[] = {
		{"clean", no_argument, NULL, OPTION_CLEAN}, {"lattice", required_argument, NULL, OPTION_LATTICE}, {0}};
	struct lattice_dims dims = LATTICE_MERL;
	bool clean = false, whole = true;
	int option;

	while ((option = options_next(self, argc, argv, "", names)) >= 0) {
		if (option == OPTION_CLEAN)
			clean = true;
		else if (!lattice_parse(optarg, &dims))
			return report_usage(self, "--lattice: '%s' is not HxDxP with 4 to %d cells each, at most %d in all", optarg,
			                    LATTICE_EXTENT_MAX, LATTICE_CELLS_MAX);
	}
	if (option != OPTIONS_END)
		return options_exit_code(option);
	if (argc - optind != 1)
		return report_usage(self, argc == optind ? "no folder" : "more than one folder");
	const char *folder = argv[optind];
	if (!folder_create(folder))
		return EXIT_FAILED;
	for (size_t i = 0; i < demo_count() && whole; i++)
		whole = material_write(i, dims, clean, folder);
	return whole ? EXIT_OK : EXIT_FAILED;
}

const struct command command_synth = {
	.name = "synth",
	.run = synth_main,
	.description = "write the demo materials as MERL files",
	.usage = "Usage: brdfpack synth [--clean] DIR\n"
	         "Writes analytic materials of every kind as MERL files (35 MB each) into DIR, which is created\n"
	         "when it is missing: with noise and unmeasured cells like a measurement's.\n"
	         "\n"
	         "      --clean          without noise and faults\n"
	         "      --lattice HxDxP  other extents than MERL's 90x90x180 (for tests)\n"
	         "  -h, --help           this text\n",
};
