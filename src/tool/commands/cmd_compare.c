#include "tool/command.h"
#include "tool/cores.h"
#include "tool/compare/compare.h"
#include "tool/interrupt.h"
#include "tool/measured.h"
#include "tool/options.h"
#include "tool/output_check.h"
#include "tool/report.h"
#include "tool/selection.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.h"
#include "output_file.h"
#include "shown.h"

/* The plan of every pixel and light is kept: 0.7 GB at 512 pixels. */
enum { COMPARE_SIZE_MAX = 512 };

struct compare {
	const char *archive_path, *folder, *images;
	unsigned workers;
	bool force;
	struct compare_report report;
	struct selection selection;
	struct measured_set measured; /* a name is NULL where there is nothing to measure */
	struct compare_item *items;
	size_t count, printed, failed;
	bool images_made; /* the pictures' folder is ours */
	struct compare_job job;
};

/* The materials that are compared: index entries of the selection. */
static bp_status items_read(struct compare *compare, bp_error *error)
{
	bp_status status = measured_set_read(&compare->selection, &compare->measured, error);
	if (status != BP_OK)
		return status;
	compare->count = compare->measured.count;
	compare->items = calloc(compare->count + 1, sizeof *compare->items);
	if (!compare->items)
		return error_memory(error, compare->count * sizeof *compare->items);
	for (size_t n = 0; n < compare->count; n++)
		compare->items[n].name = compare->measured.name[n];
	return BP_OK;
}

/* Finds every item's measured file; those without one have failed. */
static bp_status sources_find(struct compare *compare, bp_error *error)
{
	bp_status status = measured_set_find(&compare->measured, compare->folder, error);
	for (size_t n = 0; n < compare->count && status == BP_OK; n++) {
		struct compare_item *item = &compare->items[n];
		if (compare->measured.item[n].source)
			continue;
		error_set(&item->error, BP_ERROR_NOT_FOUND, BP_NO_OFFSET, "%s holds no measured file of that name", compare->folder);
		report_error(compare->archive_path, item->name, &item->error);
		item->done = item->told = true;
		compare->failed++;
		compare->measured.name[n] = NULL;
	}
	return status;
}

/* The folder for pictures, made if need be; checked before anything is computed. */
static bp_status images_prepare(struct compare *compare, bp_error *error)
{
	const char *folder = compare->images;
	struct stat status;
	compare->images_made = mkdir(folder, 0777) == 0;
	if (!compare->images_made && errno != EEXIST)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot create the folder: %s", folder, strerror(errno));
	if (stat(folder, &status) != 0 || !S_ISDIR(status.st_mode))
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: not a folder", folder);
	if (access(folder, W_OK | X_OK) != 0)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot write there: %s", folder, strerror(errno));
	return BP_OK;
}

static char *image_path(const struct compare *compare, const char *name, int light)
{
	char *path = NULL;
	return asprintf(&path, "%s/%s-%s.png", compare->images, name, lighting_name((enum lighting)light)) < 0 ? NULL : path;
}

/* Names every picture that is there and not ours to replace; true when there is none. */
static bool images_check(const struct compare *compare)
{
	struct stat about;
	bool all = true;
	for (size_t n = 0; n < compare->count; n++)
		for (int l = 0; l < LIGHTING_COUNT; l++) {
			char *path = compare->report.lightings & 1u << l ? image_path(compare, compare->items[n].name, l) : NULL;
			if (path && lstat(path, &about) == 0)
				all &= output_check(path, OUTPUT_KIND_PICTURE, compare->force, &compare->archive_path, 1);
			free(path);
		}
	return all;
}

static bp_status images_write(const struct compare *compare, const struct compare_item *item, const uint8_t *png, bp_error *error)
{
	bp_status status = BP_OK;
	for (int l = 0; l < LIGHTING_COUNT && status == BP_OK; l++) {
		uint32_t bytes = item->result.png_bytes[l];
		if (!bytes)
			continue;
		char *path = image_path(compare, item->name, l);
		if (!path)
			return error_memory(error, 512);
		status = output_file_write_whole(path, OUTPUT_REPLACE, png, bytes, error);
		free(path);
		png += bytes;
	}
	return status;
}

/* Rows and failures appear in the items' order, as soon as all before are there. */
static void rows_print(struct compare *compare)
{
	for (; compare->printed < compare->count && compare->items[compare->printed].done; compare->printed++) {
		struct compare_item *item = &compare->items[compare->printed];
		if (item->error.status && !item->told)
			report_error(compare->archive_path, item->name, &item->error);
		if (item->error.status)
			continue;
		compare_report_row(&compare->report, item);
	}
	fflush(stdout);
}

static void result_take(void *user, const struct job_result *result)
{
	struct compare *compare = user;
	struct compare_item *item = &compare->items[result->number];
	size_t whole = sizeof item->result;
	item->error = result->error;
	if (!item->error.status && result->record_bytes >= whole)
		memcpy(&item->result, result->record, whole);
	for (int l = 0; l < LIGHTING_COUNT; l++)
		whole += item->result.png_bytes[l];
	if (!item->error.status && result->record_bytes != whole)
		error_set(&item->error, BP_ERROR_IO, BP_NO_OFFSET, "the worker's answer is not whole");
	if (!item->error.status)
		item->error.status = images_write(compare, item, result->record + sizeof item->result, &item->error);
	compare->failed += item->error.status != BP_OK;
	item->done = true;
	rows_print(compare);
}

static bp_status materials_measure(struct compare *compare, bp_error *error)
{
	const struct workers_options options = {.count = compare->workers,
	                                        .work = compare_work,
	                                        .work_user = &compare->job,
	                                        .result = result_take,
	                                        .result_user = compare};
	compare->job.items = compare->measured.item;
	const bp_status status = selection_plans_make(&compare->selection, &compare->job.plans, error);
	return status == BP_OK ? workers_run(&options, compare->measured.name, compare->count, error) : status;
}

static void name_width_set(struct compare *compare)
{
	compare->report.name_width = (int)strlen("material");
	for (size_t n = 0; n < compare->count; n++) {
		int width = shown_columns(compare->items[n].name);
		if (width > compare->report.name_width)
			compare->report.name_width = width;
	}
}

static int materials_compare(struct compare *compare)
{
	bp_error error;
	bp_status status = items_read(compare, &error);
	if (status == BP_OK && compare->images)
		status = images_prepare(compare, &error);
	if (status == BP_OK && compare->images && !images_check(compare))
		return EXIT_FAILED;
	if (status == BP_OK)
		status = sources_find(compare, &error);
	if (status == BP_OK && compare->failed == compare->count)
		return EXIT_FAILED; /* nothing to compare: all of it was reported */
	if (status == BP_OK) {
		name_width_set(compare);
		status = materials_measure(compare, &error);
	}
	if (interrupt_signal())
		return 128 + interrupt_signal();
	if (status == BP_OK)
		status = compare_report_summary(&compare->report, compare->items, compare->count, compare->failed, &error);
	if (status != BP_OK)
		report_error(NULL, NULL, &error);
	return status == BP_OK && !compare->failed && !compare->selection.incomplete ? EXIT_OK : EXIT_FAILED;
}

static int compare_main(const struct command *self, int argc, char **argv)
{
	struct compare compare = {.workers = cores_usable()};
	enum lighting lighting = LIGHTING_COUNT;
	uint32_t size = SPHERE_SIZE;
	const struct option_rule rules[] = {{"light", 0, option_light, .to = &lighting},
	                                    {"size", 0, option_integer, &size, 1, COMPARE_SIZE_MAX},
	                                    {"json", 0, option_flag, .to = &compare.report.json},
	                                    {"images", 0, option_text, .to = &compare.images},
	                                    {"jobs", 'j', option_integer, &compare.workers, 1, WORKERS_MAX},
	                                    {"force", 0, option_flag, .to = &compare.force},
	                                    {0}};
	int code = options_read(self, argc, argv, rules);
	if (code != OPTIONS_END)
		return code;
	if (argc - optind < 2)
		return report_usage(self, "%s", argc == optind ? "no archive" : "no folder of measured files");
	compare.report.lightings = lightings_of(lighting);
	compare.archive_path = argv[optind];
	compare.folder = argv[optind + 1];
	if (!selection_open(&compare.selection, compare.archive_path, argv + optind + 2, argc - optind - 2))
		return EXIT_FAILED;
	compare.job = (struct compare_job){.archive = compare.selection.archive,
	                                   .images = compare.images != NULL,
	                                   .plans = {.lightings = compare.report.lightings, .size = size}};
	code = EXIT_FAILED;
	if (compare.selection.count > 0)
		code = materials_compare(&compare);
	else if (!compare.selection.incomplete)
		report_text("%s: no material in it", compare.archive_path);
	if (code != EXIT_OK && compare.images_made)
		rmdir(compare.images); /* where it holds pictures it stays */
	comparison_plans_free(&compare.job.plans);
	free(compare.items);
	measured_set_free(&compare.measured);
	selection_close(&compare.selection);
	return code;
}

const struct command command_compare = {
	.name = "compare",
	.run = compare_main,
	.description = "measure how far an archive is from the measured files",
	.usage = "Usage: brdfpack compare [OPTION]... ARCHIVE MEASURED [NAME]...\n"
			 "Compares materials of the archive (all, or those named) with the MERL files of the same names in the folder\n"
			 "MEASURED (or zip), and prints one row per material, then median, worst and mean, in two blocks:\n"
			 "  PSNR       of a rendered sphere in dB, from 8-bit and from float sRGB values\n"
			 "  dE ITP     mean colour difference of its pixels (ITU-R BT.2124); 1 is just noticeable at best\n"
			 "  log RMSE   root mean square of log10((decoded + 1e-3)/(measured + 1e-3))\n"
			 "  seen       the same over the cells that can be seen: not wholly below the horizon\n"
			 "  cube-root RMSE  of the cube roots of the values times the smaller cosine\n"
			 "  largest relative error  |decoded - measured|/(measured + 1e-2), and its angles in degrees\n"
			 "  albedo     the largest share of light sent back, for directions 0 to 85 degrees from the normal\n"
			 "Where the file is the one that was packed, the errors that the record tells of each layer\n"
			 "are measured again and must agree.\n"
			 "Cells that are invalid in the measured file count in nothing: they are black on both sides;\n"
			 "so do those that `build` would take as holes (--zeros).\n"
			 "\n"
			 "      --light=NAME   key, env or point alone (all three)\n"
			 "      --size=N       pixels of the sphere, 1 to 512 (160: what published figures are made with)\n"
			 "      --images=DIR   also write DIR/NAME-LIGHT.png: measured, decoded, difference x10;\n"
			 "                     older ones that brdfpack drew are replaced\n"
			 "      --force        replace whatever is there\n"
			 "      --json         one JSON object per material, then a summary object\n"
			 "  -j, --jobs=N       worker processes (one per usable core)\n"
			 "  -h, --help         this text\n",
};
