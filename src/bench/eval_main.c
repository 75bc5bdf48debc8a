/*
 * brdfpack-bench-eval: what a renderer waits for, beside what it would wait for with the raw table.
 *
 *     brdfpack-bench-eval [-n MATERIALS] [-s] ARCHIVE FOLDER|FILE...
 *
 * For the materials of the archive whose MERL files are given: loading against reading the raw file, evaluation against
 * nearest look-ups in the raw table of double, sampling, memory; every figure is the median over rounds and materials. With
 * -s instead: the spread of the sampling weights against cosine sampling and a fitted GGX lobe, per material.
 */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "eval_timing.h"
#include "head.h"
#include "rivals.h"

enum { SPREAD_SAMPLES = 20000 };

/*
 * Prints one row: name, mean deviation over angles by our sampling, cosine sampling and a fitted GGX lobe with cosine, the lobe's
 * roughness and share, the largest gap between the albedo and the mean weight. Adds the deviations to sums.
 */
static void spread_print(const bp_archive *archive, uint64_t index, const char *name, double sums[3])
{
	const double degrees[] = {2, 10, 25, 40, 60, 75, 84, 88};
	enum { ANGLES = sizeof degrees / sizeof *degrees };
	double theta[ANGLES], seconds, mean[3] = {0}, worst = 0;
	unsigned long long u = 1;
	bp_material *material = eval_load(archive, index, BP_FORM_EXPANDED, 1, 0, &seconds);
	if (!material)
		return;
	for (int n = 0; n < ANGLES; n++)
		theta[n] = degrees[n] * M_PI / 180;
	struct ggx_mixture fitted = ggx_fit(material, theta, ANGLES, &u);
	for (int n = 0; n < ANGLES; n++) {
		struct spread ours = spread_of(material, NULL, theta[n], 10 * SPREAD_SAMPLES, &u);
		float rgb[3];
		bp_material_albedo(material, (float)theta[n], rgb);
		double albedo = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
		worst = fmax(worst, fabs(ours.albedo / albedo - 1));
		mean[0] += ours.deviation / ANGLES;
		mean[1] += spread_of(material, &(struct ggx_mixture){0, 0}, theta[n], SPREAD_SAMPLES, &u).deviation / ANGLES;
		mean[2] += spread_of(material, &fitted, theta[n], SPREAD_SAMPLES, &u).deviation / ANGLES;
	}
	printf("%s\t%.3f\t%.3f\t%.3f\t%.3f\t%.1f\t%.5f\n", name, mean[0], mean[1], mean[2], fitted.roughness, fitted.share, worst);
	fflush(stdout);
	for (int n = 0; n < 3; n++)
		sums[n] += mean[n];
	bp_material_free(material);
}

int main(int argc, char **argv)
{
	static struct directions directions;
	static struct series all[FIGURES];
	struct source_list inputs;
	bp_archive *archive = NULL;
	bp_error error;
	size_t memory[2] = {0, 0};
	bool sampling = false;
	int option, most = 3, done = 0;
	double sums[3] = {0};

	while ((option = getopt(argc, argv, "n:s")) >= 0) {
		if (option == 'n')
			most = atoi(optarg);
		else if (option == 's')
			sampling = true;
		else
			return 2;
	}
	if (argc - optind < 2 || most < 1 || most > MOST) {
		fprintf(stderr, "usage: brdfpack-bench-eval [-n MATERIALS] [-s] ARCHIVE FOLDER|FILE...\n");
		return 2;
	}
	if (bp_archive_open(argv[optind], &archive, &error)) {
		fprintf(stderr, "brdfpack-bench-eval: %s: %s\n", argv[optind], error.message);
		return 1;
	}
	bool good = inputs_find(argv + optind + 1, argc - optind - 1, NULL, &inputs);
	inputs_thin(&inputs, (size_t)most);
	directions_make(&directions);
	head_print(stdout, argc, argv);
	if (sampling)
		printf("material\tours\tcosine\tggx+cosine\troughness\tshare\talbedo_gap\n");
	for (size_t n = 0; n < inputs.item_count && good; n++) {
		uint64_t index;
		if (bp_archive_find(archive, inputs.items[n].name, &index, &error))
			continue;
		done++;
		if (sampling)
			spread_print(archive, index, inputs.items[n].name, sums);
		else
			good = eval_time(archive, index, inputs.items[n].path, &directions, all, memory);
	}
	if (sampling && done)
		printf("(mean)\t%.3f\t%.3f\t%.3f\n", sums[0] / done, sums[1] / done, sums[2] / done);
	else if (good && done)
		eval_table_print(all, memory);
	if (!done)
		fprintf(stderr, "brdfpack-bench-eval: no material of the archive has its file here\n");
	source_list_free(&inputs);
	bp_archive_close(archive);
	return good && done ? 0 : 1;
}
