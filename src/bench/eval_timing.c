#include "eval_timing.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "merl/merl_file.h"
#include "model/table/table.h"
#include "timing.h"

static double sink; /* results go here, so that no loop is optimised away */

static void note(struct series *all, enum figure figure, double seconds) { all[figure].value[all[figure].count++] = seconds; }

static double cpu(void) { return clock_seconds(CLOCK_THREAD_CPUTIME_ID); }

static double wall(void) { return clock_seconds(CLOCK_MONOTONIC); }

/* Evaluation n is of the directions first(n) and second(n), whole batches of them beside each other. */
static int first(int n) { return n % DIRECTIONS; }

static int second(int n) { return (n + n / DIRECTIONS * (DIRECTIONS / PARTNERS)) % DIRECTIONS; }

void directions_make(struct directions *d)
{
	unsigned long long u = 1;
	for (int n = 0; n < DIRECTIONS; n++)
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

/* A hint that a file's pages be dropped from the cache. */
static void cache_drop(const char *path)
{
	const int fd = open(path, O_RDONLY | O_CLOEXEC);
	if (fd < 0)
		return;
	(void)fdatasync(fd);
	(void)posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
	close(fd);
}

static bool reads_time(const char *path, struct series *all)
{
	enum { WARM, CACHED, COLD, READS }; /* the first one fills the cache */
	bool read = true;
	for (int n = WARM; n < READS && read; n++) {
		uint8_t *bytes = NULL;
		size_t count;
		double seconds;
		if (n == COLD)
			cache_drop(path);
		read = !time_read(path, &seconds, &bytes, &count, NULL);
		if (read && n != WARM)
			note(all, n == COLD ? READ_COLD : READ_CACHED, seconds);
		free(bytes);
	}
	return read;
}

bp_material *eval_load(const bp_archive *archive, uint64_t index, bp_form form, int sampling, double max_log_rmse,
                       double *seconds)
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
	static const struct {
		bp_form form;
		enum figure figure;
	} LOADS[] = {{BP_FORM_EXPANDED, LOAD_EXPANDED}, {BP_FORM_COMPACT, LOAD_COMPACT}, {BP_FORM_PREVIEW, LOAD_PREVIEW}};
	bp_layer preview;
	if (bp_archive_layers(archive, index, sizeof preview, &preview, 1, NULL, NULL))
		return;
	for (size_t n = 0; n < sizeof LOADS / sizeof *LOADS; n++) {
		const bool part = LOADS[n].form == BP_FORM_PREVIEW;
		double seconds;
		if (part && info->layer_count < 2)
			continue;
		bp_material *material = eval_load(archive, index, LOADS[n].form, 0, part ? preview.log_rmse : 0, &seconds);
		if (material)
			note(all, LOADS[n].figure, seconds);
		bp_material_free(material);
	}
}

static void raw_take(const struct lattice *raw, uint32_t i, uint32_t j, uint32_t k)
{
	const size_t cell = lattice_index(LATTICE_MERL, i < 89 ? i : 89, j < 89 ? j : 89, k < 179 ? k : 179);
	sink += raw->rgb[0][cell] + raw->rgb[1][cell] + raw->rgb[2][cell];
}

/* The database's own way: arccosines and arctangents, and the cell by truncation. */
static void raw_libm(const struct lattice *raw, const struct directions *d)
{
	for (int n = 0; n < EVALUATIONS; n++) {
		const float *fi = d->wi[first(n)], *fo = d->wo[second(n)];
		const double wi[3] = {(double)fi[0], (double)fi[1], (double)fi[2]}, wo[3] = {(double)fo[0], (double)fo[1], (double)fo[2]};
		double h[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]}, length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
		for (int c = 0; c < 3; c++)
			h[c] /= length;
		double theta_h = acos(fmin(1, h[2])), phi_h = atan2(h[1], h[0]),
			   theta_d = acos(fmin(1, h[0] * wi[0] + h[1] * wi[1] + h[2] * wi[2]));
		double x = cos(phi_h) * wi[0] + sin(phi_h) * wi[1], y = -sin(phi_h) * wi[0] + cos(phi_h) * wi[1];
		double phi_d = atan2(y, cos(theta_h) * x - sin(theta_h) * wi[2]);
		phi_d = phi_d < 0 ? phi_d + M_PI : phi_d;
		raw_take(raw, (uint32_t)(sqrt(theta_h / M_PI_2) * 90), (uint32_t)(theta_d / M_PI_2 * 90), (uint32_t)(phi_d / M_PI * 180));
	}
}

static void raw_ours(const struct lattice *raw, const struct directions *d)
{
	const f32x4 scale = lattice_scale_of(LATTICE_MERL);
	for (int n = 0; n < EVALUATIONS; n++) {
		f32x4 at = {0, 0, 0, 0};
		direction_locate(scale, d->wi[first(n)], d->wo[second(n)], &at);
		raw_take(raw, (uint32_t)at[0], (uint32_t)at[1], (uint32_t)at[2]);
	}
}

static void one_by_one(const bp_material *material, const struct directions *d)
{
	for (int n = 0; n < EVALUATIONS; n++) {
		float rgb[3];
		bp_material_evaluate(material, d->wi[first(n)], d->wo[second(n)], rgb);
		sink += (double)(rgb[0] + rgb[1] + rgb[2]);
	}
}

static void batch(const bp_material *material, struct directions *d, int n)
{
	const int i = first(n), o = second(n);
	bp_material_evaluate_batch(material, BATCH, (const float *const[]){d->in[0] + i, d->in[1] + i, d->in[2] + i},
	                           (const float *const[]){d->in[3] + o, d->in[4] + o, d->in[5] + o},
	                           (float *const[]){d->out[0], d->out[1], d->out[2]});
}

static void in_batches(const bp_material *material, struct directions *d)
{
	for (int n = 0; n < EVALUATIONS; n += BATCH)
		batch(material, d, n);
}

/* The batch's values are those of single calls, and finite; false otherwise. */
static bool values_hold(const bp_material *material, struct directions *d)
{
	for (int n = 0; n < EVALUATIONS; n++) {
		float rgb[3];
		if (n % BATCH == 0)
			batch(material, d, n);
		bp_material_evaluate(material, d->wi[first(n)], d->wo[second(n)], rgb);
		for (int c = 0; c < 3; c++)
			if (!(rgb[c] >= 0 && isfinite(rgb[c]) && rgb[c] == d->out[c][n % BATCH]))
				return false;
	}
	return true;
}

static void draws(const bp_material *material, const struct directions *d)
{
	float wi[3];
	for (int n = 0; n < EVALUATIONS; n++)
		sink += (double)bp_material_sample(material, d->wo[second(n)], d->u[first(n)], wi);
}

static void densities(const bp_material *material, const struct directions *d)
{
	for (int n = 0; n < EVALUATIONS; n++)
		sink += (double)bp_material_pdf(material, d->wi[first(n)], d->wo[second(n)]);
}

#define TIMED(figure, work) \
	do { \
		work; /* to warm up */ \
		double start = cpu(); \
		work; \
		note(all, figure, (cpu() - start) / EVALUATIONS); \
	} while (0)

static bool evaluations_time(const struct lattice *raw, const bp_material *expanded, const bp_material *compact,
                             struct directions *d, struct series *all)
{
	TIMED(RAW_LIBM, raw_libm(raw, d));
	TIMED(RAW_OURS, raw_ours(raw, d));
	TIMED(ONE_EXPANDED, one_by_one(expanded, d));
	TIMED(RAW_OURS, raw_ours(raw, d));
	TIMED(ONE_COMPACT, one_by_one(compact, d));
	TIMED(BATCH_COMPACT, in_batches(compact, d));
	bool hold = values_hold(compact, d);
	TIMED(BATCH_EXPANDED, in_batches(expanded, d));
	hold = hold && values_hold(expanded, d);
	TIMED(DRAW, draws(expanded, d));
	TIMED(DENSITY, densities(expanded, d));
	return hold;
}

bool eval_time(const bp_archive *archive, uint64_t index, const char *path, struct directions *d, struct series all[FIGURES],
               size_t memory[2])
{
	bp_material_info info = {.struct_bytes = sizeof info};
	bp_loaded loaded = {.struct_bytes = sizeof loaded};
	struct lattice raw = {0};
	bp_error error;
	double seconds;
	bool good = true;
	if (bp_archive_info(archive, index, &info, &error) || lattice_read_path(path, NULL, &raw, &error)) {
		fprintf(stderr, "brdfpack-bench-eval: %s: %s\n", path, error.message);
		return false;
	}
	bp_material *expanded = eval_load(archive, index, BP_FORM_EXPANDED, 1, 0, &seconds),
				*compact = eval_load(archive, index, BP_FORM_COMPACT, 1, 0, &seconds);
	good = expanded && compact;
	for (int form = 0; form < 2 && good; form++) {
		bp_material_loaded(form ? compact : expanded, &loaded, NULL);
		memory[form] = loaded.memory_bytes;
	}
	for (int round = 0; round < ROUNDS && good; round++) {
		good = reads_time(path, all);
		if (good)
			loads_time(archive, index, &info, all);
		good = good && evaluations_time(&raw, expanded, compact, d, all) && isfinite(sink);
	}
	if (!good)
		fprintf(stderr, "brdfpack-bench-eval: %s: cannot be read, or its values do not hold\n", path);
	bp_material_free(expanded);
	bp_material_free(compact);
	lattice_free(&raw);
	return good;
}
