#include "tool/command.h"
#include "tool/material.h"
#include "tool/options.h"
#include "tool/output_check.h"
#include "tool/report.h"

#include "render/picture.h"

#include <stdlib.h>

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
	bp_error error;
	int code = EXIT_OK;

	if (table_make(material, &table, &error) || sphere_image_alloc(options->size, &image, &error) ||
	    sphere_render(options->lighting, &table, &image, &error))
		code = report_error(material->path, material->name, &error);
	else if (image_write(options, &image, &error))
		code = report_error(NULL, NULL, &error); /* names the output */
	sphere_image_free(&image);
	lookup_table_free(&table);
	return code;
}

static int render_main(const struct command *self, int argc, char **argv)
{
	struct render_options options = {.lighting = LIGHTING_KEY, .size = SPHERE_SIZE};
	struct material material;
	const struct option_rule rules[] = {{"light", 0, option_light, .to = &options.lighting},
	                                    {"size", 0, option_integer, &options.size, 1, SPHERE_SIZE_MAX},
	                                    {"output", 'o', option_text, .to = &options.output},
	                                    {"force", 0, option_flag, .to = &options.force},
	                                    {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	if (!option_picture(self, options.output, ".pfm", &options.pfm))
		return EXIT_USAGE;
	if (optind < argc && !output_check(options.output, OUTPUT_KIND_PICTURE, options.force, (const char *const *)argv + optind, 1))
		return EXIT_FAILED;
	code = material_load(self, argv + optind, argc - optind, &material);
	if (code != EXIT_OK)
		return code;
	if (material.measured && argc - optind > 1)
		code = report_usage(self, "'%s' is a measured file, of one material: '%s' is too much", material.path, argv[optind + 1]);
	else
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
