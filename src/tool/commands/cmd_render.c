#include "tool/command.h"
#include "tool/material.h"
#include "tool/options.h"
#include "tool/output_check.h"
#include "tool/report.h"

#include "render/picture.h"

#include <stdlib.h>
#include <string.h>

struct render_options {
	enum lighting lighting;
	uint32_t size;
	const char *output;
	bool pfm, force;
};

/* The material's table as a renderer sees it: cells that nobody measured are black. */
static bp_status table_make(const struct material *material, struct lookup_table *table, bp_error *error)
{
	return material->measured ? lookup_table_measured(&material->lattice, table, error)
	                          : material_lookup(&material->head, &material->table, table, error);
}

static bp_status image_write(const struct render_options *options, const struct sphere_image *image, bp_error *error)
{
	struct picture picture;
	double exposure;
	bp_status status;
	if (options->pfm)
		return image_write_pfm(options->output, image, error);
	if ((status = image_exposure(image, &exposure, error)) != BP_OK)
		return status;
	if ((status = picture_alloc(image->size, image->size, &picture, error)) != BP_OK)
		return status;
	picture_place(&picture, 0, image, exposure);
	status = picture_write_png(options->output, &picture, error);
	picture_free(&picture);
	return status;
}

static int material_render(const struct render_options *options, const struct material *material)
{
	struct lookup_table table = {0};
	struct sphere_image image = {0};
	const struct lookup_table *tables[1] = {&table};
	struct sphere_image *images[1] = {&image};
	bp_error error;
	int code = EXIT_FAILED;

	if (table_make(material, &table, &error) || sphere_image_alloc(options->size, &image, &error) ||
	    sphere_render(options->lighting, tables, 1, images, &error)) {
		report_error(material->path, material->name, &error);
	} else if (image_write(options, &image, &error)) {
		report_error(NULL, NULL, &error); /* names the output */
	} else {
		code = EXIT_OK;
	}
	sphere_image_free(&image);
	lookup_table_free(&table);
	return code;
}

static int render_main(const struct command *self, int argc, char **argv)
{
	enum { LIGHT = OPTION_LONG, SIZE, FORCE };
	static const struct option names[] = {{"light", required_argument, NULL, LIGHT},
	                                      {"size", required_argument, NULL, SIZE},
	                                      {"output", required_argument, NULL, 'o'},
	                                      {"force", no_argument, NULL, FORCE},
	                                      {0}};
	struct render_options options = {.lighting = LIGHTING_KEY, .size = SPHERE_SIZE};
	struct material material;
	int64_t size;
	int option;

	while ((option = options_next(self, argc, argv, "o:", names)) >= 0)
		switch (option) {
		case 'o': options.output = optarg; break;
		case FORCE: options.force = true; break;
		case LIGHT:
			if (!option_light(self, optarg, &options.lighting))
				return EXIT_USAGE;
			break;
		case SIZE:
			if (!option_integer(self, "--size", optarg, 1, SPHERE_SIZE_MAX, &size))
				return EXIT_USAGE;
			options.size = (uint32_t)size;
			break;
		}
	if (option != OPTIONS_END)
		return options_exit_code(option);
	if (!option_picture(self, options.output, ".pfm", &options.pfm))
		return EXIT_USAGE;
	if (optind < argc && !output_check(options.output, OUTPUT_KIND_PICTURE, options.force, (const char *const *)argv + optind, 1))
		return EXIT_FAILED;
	int code = material_load(self, argv + optind, argc - optind, &material);
	if (code != EXIT_OK)
		return code;
	code = material_render(&options, &material);
	material_free(&material);
	return code;
}

const struct command command_render = {
	.name = "render",
	.run = render_main,
	.description = "draw a sphere of a material",
	.usage = "Usage: brdfpack render [OPTION]... -o OUT.png|OUT.pfm ARCHIVE NAME\n"
			 "       brdfpack render [OPTION]... -o OUT.png|OUT.pfm MERL-FILE\n"
			 "Draws a sphere under fixed lights. A .png file is exposed so that the 90th percentile of the covered\n"
			 "pixels becomes 0.9, in sRGB; a .pfm file holds the linear radiances as float.\n"
			 "\n"
			 "  -o, --output=FILE  the image to write; an older .png that brdfpack drew is replaced\n"
			 "      --force        replace whatever is there\n"
			 "      --light=NAME   key: 29 directional lights (default); env: a sky of 400 directions;\n"
			 "                     point: four point lights\n"
			 "      --size=N       width and height in pixels, 1 to 4096 (160)\n"
			 "  -h, --help         this text\n",
};
