/*
 * brdfpack-bench-eval: what a renderer waits for, beside what it would wait for with the raw table.
 *
 *     brdfpack-bench-eval [-n MATERIALS] [-s] ARCHIVE FOLDER|FILE...
 *
 * For the materials of the archive whose MERL files are given: loading against reading the raw file, evaluation against
 * nearest look-ups in the raw table of double, sampling, memory. Yardsticks stand in the same round as what is compared
 * with them; every figure is the median over rounds and materials. With -s instead: the spread of the sampling weights
 * against cosine sampling and a fitted GGX lobe, per material.
 */
#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../brdfpack.h"
#include "../merl/merl_file.h"
#include "../model/direction.h"
#include "head.h"
#include "inputs.h"
#include "rivals.h"
#include "timing.h"

enum { ROUNDS = 7, EVALUATIONS = 1 << 17, BATCH = 1024, MOST = MATERIALS_MAX, SPREAD_SAMPLES = 20000 };

enum figure {
	READ_CACHED, READ_COLD, LOAD_EXPANDED, LOAD_COMPACT, LOAD_SAMPLING, LOAD_PREVIEW,
	RAW_LIBM, RAW_OURS, ONE_EXPANDED, ONE_COMPACT, NEAREST_EXPANDED, BATCH_EXPANDED, BATCH_COMPACT, DRAW, DENSITY, FIGURES
};
static const struct {
	const char *what, *unit, *yardstick;
	enum figure against;
	double scale;
} ROWS[FIGURES] = {
	[READ_CACHED] = {"read the raw file, from the page cache", "ms", NULL, 0, 1e3},
	[READ_COLD] = {"read the raw file, from storage", "ms", NULL, 0, 1e3},
	[LOAD_EXPANDED] = {"load, all layers, expanded", "ms", "cached read", READ_CACHED, 1e3},
	[LOAD_COMPACT] = {"load, all layers, compact", "ms", "cached read", READ_CACHED, 1e3},
	[LOAD_SAMPLING] = {"load, all layers, expanded, with sampling", "ms", "cached read", READ_CACHED, 1e3},
	[LOAD_PREVIEW] = {"load, first layer, preview", "ms", "all layers", LOAD_EXPANDED, 1e3},
	[RAW_LIBM] = {"nearest look-up in the raw table, acos and atan2", "ns", NULL, 0, 1e9},
	[RAW_OURS] = {"nearest look-up in the raw table, our angles", "ns", NULL, 0, 1e9},
	[ONE_EXPANDED] = {"evaluate one, interpolated, expanded", "ns", "raw, our angles", RAW_OURS, 1e9},
	[ONE_COMPACT] = {"evaluate one, interpolated, compact", "ns", "raw, our angles", RAW_OURS, 1e9},
	[NEAREST_EXPANDED] = {"evaluate one, nearest, expanded", "ns", "raw, our angles", RAW_OURS, 1e9},
	[BATCH_EXPANDED] = {"evaluate 1024, each, expanded", "ns", "raw, our angles", RAW_OURS, 1e9},
	[BATCH_COMPACT] = {"evaluate 1024, each, compact", "ns", "raw, our angles", RAW_OURS, 1e9},
	[DRAW] = {"sample and its density", "ns", NULL, 0, 1e9},
	[DENSITY] = {"density of a given pair", "ns", NULL, 0, 1e9},
};

/* The measurements of one figure, over all rounds and materials. */
struct series {
	double value[ROUNDS * MOST];
	int count;
};

struct directions {
	float wi[EVALUATIONS][3], wo[EVALUATIONS][3], u[EVALUATIONS][3];
	float in[6][EVALUATIONS], out[3][EVALUATIONS];
};

static double sink; /* results go here, so that no loop is optimised away */

static int ascending(const void *a, const void *b)
{
	double x = *(const double *)a, y = *(const double *)b;
	return (x > y) - (x < y);
}

static double median(struct series *series)
{
	qsort(series->value, (size_t)series->count, sizeof *series->value, ascending);
	return series->count ? series->value[series->count / 2] : NAN;
}

static void note(struct series *all, enum figure figure, double seconds)
{
	all[figure].value[all[figure].count++] = seconds;
}

static double cpu(void)
{
	return clock_seconds(CLOCK_THREAD_CPUTIME_ID);
}

static double wall(void)
{
	return clock_seconds(CLOCK_MONOTONIC);
}

/* Uniform over the hemisphere, which touches more of the table than what a renderer does. */
static void directions_make(struct directions *d)
{
	unsigned long long u = 1;
	for (int n = 0; n < EVALUATIONS; n++)
		for (int side = 0; side < 2; side++) {
			float *w = side ? d->wo[n] : d->wi[n];
			double z = 1 - uniform_next(&u), phi = 2 * M_PI * uniform_next(&u), r = sqrt(1 - z * z);
			w[0] = (float)(r * cos(phi));
			w[1] = (float)(r * sin(phi));
			w[2] = (float)z;
			for (int c = 0; c < 3; c++) {
				d->in[3 * side + c][n] = w[c];
				d->u[n][c] = (float)uniform_next(&u);
			}
		}
}

static bool read_whole(const char *path, bool cold, double *seconds, uint8_t *bytes, size_t room)
{
	int fd = open(path, O_RDONLY | O_CLOEXEC);
	if (fd < 0)
		return false;
	if (cold) {
		(void)fdatasync(fd);
		(void)posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
	}
	double start = wall();
	ssize_t got;
	for (size_t done = 0; (got = read(fd, bytes + done, room - done)) > 0;)
		done += (size_t)got;
	*seconds = wall() - start;
	close(fd);
	return got == 0;
}

static bool reads_time(const char *path, struct series *all)
{
	size_t room = merl_file_bytes(LATTICE_MERL) + 1;
	double seconds;
	uint8_t *bytes = malloc(room);
	bool read = bytes && read_whole(path, false, &seconds, bytes, room); /* the first one fills the cache and the pages */
	for (int cold = 0; cold < 2 && read; cold++) {
		free(bytes);
		bytes = malloc(room); /* fresh memory, as a program that loads it has */
		read = bytes && read_whole(path, cold, &seconds, bytes, room);
		if (read)
			note(all, cold ? READ_COLD : READ_CACHED, seconds);
	}
	free(bytes);
	return read;
}

static bp_material *load(const bp_archive *archive, uint64_t index, bp_form form, int sampling, double max_log_rmse, double *seconds)
{
	bp_load_options options = {.struct_bytes = sizeof options, .form = form, .sampling = sampling, .max_log_rmse = max_log_rmse};
	bp_material *material = NULL;
	bp_error error;
	double start = wall();
	if (bp_material_load(archive, index, &options, &material, &error)) {
		fprintf(stderr, "brdfpack-bench-eval: %s\n", error.message);
		return NULL;
	}
	*seconds = wall() - start;
	return material;
}

static void loads_time(const bp_archive *archive, uint64_t index, const bp_material_info *info, struct series *all)
{
	const double first = info->layers[0].log_rmse;
	double seconds;
	bp_material *material = load(archive, index, BP_FORM_EXPANDED, 0, 0, &seconds);
	bp_material_free(material);
	if (material)
		note(all, LOAD_EXPANDED, seconds);
	material = load(archive, index, BP_FORM_COMPACT, 0, 0, &seconds);
	bp_material_free(material);
	if (material)
		note(all, LOAD_COMPACT, seconds);
	material = load(archive, index, BP_FORM_EXPANDED, 1, 0, &seconds);
	bp_material_free(material);
	if (material)
		note(all, LOAD_SAMPLING, seconds);
	material = info->layer_count > 1 ? load(archive, index, BP_FORM_PREVIEW, 0, first, &seconds) : NULL;
	bp_material_free(material);
	if (material)
		note(all, LOAD_PREVIEW, seconds);
}

/* The database's own way: arccosines and arctangents, and the cell by truncation. */
static void raw_libm(const struct lattice *raw, const struct directions *d)
{
	for (int n = 0; n < EVALUATIONS; n++) {
		const double wi[3] = {(double)d->wi[n][0], (double)d->wi[n][1], (double)d->wi[n][2]};
		const double wo[3] = {(double)d->wo[n][0], (double)d->wo[n][1], (double)d->wo[n][2]};
		double h[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]}, length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
		for (int c = 0; c < 3; c++)
			h[c] /= length;
		double theta_h = acos(fmin(1, h[2])), phi_h = atan2(h[1], h[0]), theta_d = acos(fmin(1, h[0] * wi[0] + h[1] * wi[1] + h[2] * wi[2]));
		double x = cos(phi_h) * wi[0] + sin(phi_h) * wi[1], y = -sin(phi_h) * wi[0] + cos(phi_h) * wi[1];
		double phi_d = atan2(y, cos(theta_h) * x - sin(theta_h) * wi[2]);
		phi_d = phi_d < 0 ? phi_d + M_PI : phi_d;
		uint32_t i = (uint32_t)(sqrt(theta_h / M_PI_2) * 90), j = (uint32_t)(theta_d / M_PI_2 * 90), k = (uint32_t)(phi_d / M_PI * 180);
		size_t cell = lattice_index(LATTICE_MERL, i < 89 ? i : 89, j < 89 ? j : 89, k < 179 ? k : 179);
		sink += raw->rgb[0][cell] + raw->rgb[1][cell] + raw->rgb[2][cell];
	}
}

static void raw_ours(const struct lattice *raw, const struct directions *d)
{
	const f32x4 scale = lattice_scale_of(LATTICE_MERL);
	for (int n = 0; n < EVALUATIONS; n++) {
		f32x4 at = {0, 0, 0, 0};
		direction_locate(scale, d->wi[n], d->wo[n], &at);
		uint32_t i = (uint32_t)at[0], j = (uint32_t)at[1], k = (uint32_t)at[2];
		size_t cell = lattice_index(LATTICE_MERL, i < 89 ? i : 89, j < 89 ? j : 89, k < 179 ? k : 179);
		sink += raw->rgb[0][cell] + raw->rgb[1][cell] + raw->rgb[2][cell];
	}
}

static void one_by_one(const bp_material *material, const struct directions *d, bool nearest)
{
	for (int n = 0; n < EVALUATIONS; n++) {
		float rgb[3];
		if (nearest)
			bp_material_nearest(material, d->wi[n], d->wo[n], rgb);
		else
			bp_material_evaluate(material, d->wi[n], d->wo[n], rgb);
		sink += (double)(rgb[0] + rgb[1] + rgb[2]);
	}
}

static void in_batches(const bp_material *material, struct directions *d)
{
	for (int n = 0; n < EVALUATIONS; n += BATCH)
		bp_material_evaluate_batch(material, BATCH, (const float *const[]){d->in[0] + n, d->in[1] + n, d->in[2] + n},
		                           (const float *const[]){d->in[3] + n, d->in[4] + n, d->in[5] + n},
		                           (float *const[]){d->out[0] + n, d->out[1] + n, d->out[2] + n});
}

/* The batch's values are those of single calls, and finite; false otherwise. */
static bool values_hold(const bp_material *material, const struct directions *d)
{
	for (int n = 0; n < EVALUATIONS; n++) {
		float rgb[3];
		bp_material_evaluate(material, d->wi[n], d->wo[n], rgb);
		for (int c = 0; c < 3; c++)
			if (!(rgb[c] >= 0 && isfinite(rgb[c]) && rgb[c] == d->out[c][n]))
				return false;
	}
	return true;
}

#define TIMED(figure, work)                                               \
	do {                                                                  \
		double start = cpu();                                             \
		work;                                                             \
		note(all, figure, (cpu() - start) / EVALUATIONS);                 \
	} while (0)

static bool evaluations_time(const struct lattice *raw, const bp_material *expanded, const bp_material *compact, struct directions *d,
                             struct series *all)
{
	TIMED(RAW_LIBM, raw_libm(raw, d));
	TIMED(RAW_OURS, raw_ours(raw, d));
	TIMED(ONE_EXPANDED, one_by_one(expanded, d, false));
	TIMED(RAW_OURS, raw_ours(raw, d));
	TIMED(ONE_COMPACT, one_by_one(compact, d, false));
	TIMED(NEAREST_EXPANDED, one_by_one(expanded, d, true));
	TIMED(BATCH_COMPACT, in_batches(compact, d));
	bool hold = values_hold(compact, d);
	TIMED(BATCH_EXPANDED, in_batches(expanded, d));
	hold = hold && values_hold(expanded, d);
	float wi[3];
	TIMED(DRAW, for (int n = 0; n < EVALUATIONS; n++) sink += (double)bp_material_sample(expanded, d->wo[n], d->u[n], wi));
	TIMED(DENSITY, for (int n = 0; n < EVALUATIONS; n++) sink += (double)bp_material_pdf(expanded, d->wi[n], d->wo[n]));
	return hold;
}

static bool material_time(const bp_archive *archive, uint64_t index, const char *path, struct directions *d, struct series *all, size_t memory[2])
{
	bp_material_info info = {.struct_bytes = sizeof info};
	bp_loaded loaded = {.struct_bytes = sizeof loaded};
	struct lattice raw = {0};
	bp_error error;
	double seconds;
	bool good = true;
	if (bp_archive_info(archive, index, &info, &error) || lattice_read_path(path, NULL, NULL, false, &raw, &error)) {
		fprintf(stderr, "brdfpack-bench-eval: %s: %s\n", path, error.message);
		return false;
	}
	bp_material *expanded = load(archive, index, BP_FORM_EXPANDED, 1, 0, &seconds), *compact = load(archive, index, BP_FORM_COMPACT, 1, 0, &seconds);
	good = expanded && compact;
	for (int form = 0; form < 2 && good; form++) {
		bp_material_loaded(form ? compact : expanded, &loaded, NULL);
		memory[form] = loaded.memory_bytes;
	}
	for (int round = 0; round < ROUNDS && good; round++) {
		good = reads_time(path, all);
		if (good)
			loads_time(archive, index, &info, all);
		good = good && evaluations_time(&raw, expanded, compact, d, all);
	}
	if (!good)
		fprintf(stderr, "brdfpack-bench-eval: %s: cannot be read, or its values do not hold\n", path);
	bp_material_free(expanded);
	bp_material_free(compact);
	lattice_free(&raw);
	return good;
}

static void table_print(struct series *all, const size_t memory[2])
{
	double middle[FIGURES];
	for (int n = 0; n < FIGURES; n++)
		middle[n] = median(&all[n]);
	printf("| | ratio | to | median |\n|---|---|---|---|\n");
	for (int n = 0; n < FIGURES; n++) {
		if (all[n].count == 0)
			continue;
		if (ROWS[n].yardstick)
			printf("| %s | %.2f | %s | %.1f %s |\n", ROWS[n].what, middle[n] / middle[ROWS[n].against], ROWS[n].yardstick,
			       middle[n] * ROWS[n].scale, ROWS[n].unit);
		else
			printf("| %s | | | %.1f %s |\n", ROWS[n].what, middle[n] * ROWS[n].scale, ROWS[n].unit);
	}
	double raw_bytes = (double)merl_file_bytes(LATTICE_MERL);
	printf("| memory, expanded, with sampling | %.2f | raw table | %.3f MB |\n", (double)memory[0] / raw_bytes, (double)memory[0] / 1e6);
	printf("| memory, compact, with sampling | %.2f | raw table | %.3f MB |\n", (double)memory[1] / raw_bytes, (double)memory[1] / 1e6);
}

/* One row of the sampling table; adds to sums. */
static void spread_print(const bp_archive *archive, uint64_t index, const char *name, double sums[3])
{
	const double degrees[] = {2, 10, 25, 40, 60, 75, 84, 88};
	enum { ANGLES = sizeof degrees / sizeof *degrees };
	double theta[ANGLES], seconds, mean[3] = {0}, worst = 0;
	unsigned long long u = 1;
	bp_material *material = load(archive, index, BP_FORM_EXPANDED, 1, 0, &seconds);
	if (!material)
		return;
	for (int n = 0; n < ANGLES; n++)
		theta[n] = degrees[n] * M_PI / 180;
	struct ggx_mixture fitted = ggx_fit(material, theta, ANGLES, &u);
	for (int n = 0; n < ANGLES; n++) {
		struct spread ours = spread_of_material(material, theta[n], 10 * SPREAD_SAMPLES, &u);
		float rgb[3];
		bp_material_albedo(material, (float)theta[n], rgb);
		double albedo = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
		worst = fmax(worst, fabs(ours.albedo / albedo - 1));
		mean[0] += ours.deviation / ANGLES;
		mean[1] += spread_of_ggx(material, (struct ggx_mixture){0, 0}, theta[n], SPREAD_SAMPLES, &u).deviation / ANGLES;
		mean[2] += spread_of_ggx(material, fitted, theta[n], SPREAD_SAMPLES, &u).deviation / ANGLES;
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
			good = material_time(archive, index, inputs.paths[n], &directions, all, memory);
	}
	if (sampling && done)
		printf("(mean)\t%.3f\t%.3f\t%.3f\n", sums[0] / done, sums[1] / done, sums[2] / done);
	else if (good && done)
		table_print(all, memory);
	if (!done)
		fprintf(stderr, "brdfpack-bench-eval: no material of the archive has its file here\n");
	inputs_free(&inputs);
	bp_archive_close(archive);
	return good && done && isfinite(sink) ? 0 : 1;
}
