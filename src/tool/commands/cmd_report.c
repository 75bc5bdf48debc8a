#include "tool/command.h"
#include "tool/cores.h"
#include "tool/options.h"
#include "tool/output_check.h"
#include "tool/report.h"
#include "tool/report_page/page.h"
#include "tool/workers.h"

#include "render/lights.h"

static int report_main(const struct command *self, int argc, char **argv)
{
	struct page_options options = {.workers = cores_usable()};
	struct selection selection;
	enum lighting lighting = LIGHTING_COUNT;
	bool force = false;
	const struct option_rule rules[] = {{"output", 'o', option_output, .to = &options.output},
	                                    {"measured", 0, option_text, .to = &options.measured},
	                                    {"light", 0, option_light, .to = &lighting},
	                                    {"embed", 0, option_flag, .to = &options.embed},
	                                    {"jobs", 'j', option_integer, &options.workers, 1, WORKERS_MAX},
	                                    {"quiet", 'q', option_flag, .to = &options.quiet},
	                                    {"force", 0, option_flag, .to = &force},
	                                    {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	options.lightings = lightings_of(lighting);
	if (!text_ends_with(options.output, ".html"))
		return report_usage(self, "-o: '%s' does not end in .html", options.output);
	if (optind < argc && !output_check(options.output, OUTPUT_KIND_PAGE, force, (const char *const *)argv + optind, 1))
		return EXIT_FAILED;
	code = selection_from(&selection, self, argv + optind, argc - optind);
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
