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
#include <stdio.h>
#include <stdlib.h>

#include "eval_spread.h"
#include "eval_timing.h"
#include "head.h"

int main(int argc, char **argv)
{
	static struct directions directions;
	static struct series all[FIGURES];
	struct inputs inputs = {0};
	bp_archive *archive = NULL;
	bp_error error;
	size_t memory[2] = {0, 0};
	bool sampling = false, good = true;
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
	for (int n = optind + 1; n < argc; n++)
		good = inputs_add(&inputs, argv[n]) && good;
	inputs_sort(&inputs);
	if (inputs.count > most)
		inputs_thin(&inputs, most);
	directions_make(&directions);
	head_print(stdout, argc, argv);
	if (sampling)
		printf("material\tours\tcosine\tggx+cosine\troughness\tshare\talbedo_gap\n");
	for (int n = 0; n < inputs.count && good; n++) {
		char name[BP_NAME_BYTES_MAX + 1];
		uint64_t index;
		inputs_name(inputs.paths[n], name, sizeof name);
		if (bp_archive_find(archive, name, &index, &error))
			continue;
		done++;
		if (sampling)
			spread_print(archive, index, name, sums);
		else
			good = eval_time(archive, index, inputs.paths[n], &directions, all, memory);
	}
	if (sampling && done)
		printf("(mean)\t%.3f\t%.3f\t%.3f\n", sums[0] / done, sums[1] / done, sums[2] / done);
	else if (good && done)
		eval_table_print(all, memory);
	if (!done)
		fprintf(stderr, "brdfpack-bench-eval: no material of the archive has its file here\n");
	inputs_free(&inputs);
	bp_archive_close(archive);
	return good && done ? 0 : 1;
}
