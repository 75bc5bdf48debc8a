#include "tool/command.h"
#include "tool/cores.h"
#include "tool/options.h"
#include "tool/output_check.h"
#include "tool/report.h"
#include "tool/report_page/page.h"

#include "render/lights.h"

static int report_main(const struct command *self, int argc, char **argv)
{
	enum { LIGHT = OPTION_LONG, MEASURED, EMBED, FORCE };
	static const struct option names[] = {
		{"output", required_argument, NULL, 'o'},  {"measured", required_argument, NULL, MEASURED},
		{"light", required_argument, NULL, LIGHT}, {"embed", no_argument, NULL, EMBED},
		{"jobs", required_argument, NULL, 'j'},    {"quiet", no_argument, NULL, 'q'},
		{"force", no_argument, NULL, FORCE},       {0}};
	struct page_options options = {.workers = cores_usable(), .lightings = (1u << LIGHTING_COUNT) - 1};
	struct selection selection;
	enum lighting lighting;
	bool force = false;
	int option;

	while ((option = options_next(self, argc, argv, "o:j:q", names)) >= 0)
		switch (option) {
		case 'o': options.output = optarg; break;
		case MEASURED: options.measured = optarg; break;
		case LIGHT:
			if (!option_light(self, optarg, &lighting))
				return EXIT_USAGE;
			options.lightings = 1u << lighting;
			break;
		case EMBED: options.embed = true; break;
		case FORCE: force = true; break;
		case 'q': options.quiet = true; break;
		case 'j':
			if (!option_jobs(self, optarg, &options.workers))
				return EXIT_USAGE;
			break;
		}
	if (option != OPTIONS_END)
		return options_exit_code(option);
	if (!option_output(self, options.output, "OUT.html"))
		return EXIT_USAGE;
	if (!text_ends_with(options.output, ".html"))
		return report_usage(self, "-o: '%s' does not end in .html", options.output);
	if (optind < argc && !output_check(options.output, OUTPUT_KIND_PAGE, force, (const char *const *)argv + optind, 1))
		return EXIT_FAILED;
	int code = selection_from(&selection, self, argv + optind, argc - optind);
	if (code != EXIT_OK)
		return code;
	code = selection.count || !selection.incomplete ? page_run(&options, &selection) : EXIT_FAILED;
	selection_close(&selection);
	return code;
}

const struct command command_report = {
	.name = "report",
	.run = report_main,
	.description = "make a page that shows an archive",
	.usage =
		"Usage: brdfpack report [OPTION]... -o OUT.html ARCHIVE [NAME]...\n"
		"Writes one HTML page that shows the materials (all, or those named): spheres under three lightings, polar plots,\n"
		"directional albedo, slices, what each layer costs and leaves, the parameters, and what is known of the source; of\n"
		"the archive bytes against error, the ten with the largest error, and what verify said. It needs no network, and\n"
		"no script to be read. With more than 150 materials it is a contact sheet.\n"
		"Where the viewer was built (make viewer), the page also reads the archive itself when it is embedded, or lies\n"
		"beside the page on a web server: spheres to light and turn. A material that is damaged is named, the others shown,\n"
		"and the exit code is 1.\n"
		"\n"
		"  -o, --output=FILE    the page to write; an older one that brdfpack made is replaced\n"
		"      --measured=DIR   compare with the MERL files of the same names in this folder (or zip)\n"
		"      --light=NAME     key, env or point alone (all three)\n"
		"      --embed          put the archive's bytes into the page, so that the viewer works from a file\n"
		"      --force          replace whatever is there\n"
		"  -j, --jobs=N         worker processes (one per usable core)\n"
		"  -q, --quiet          no progress\n"
		"  -h, --help           this text\n",
};
