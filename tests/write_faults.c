/*
 * write_faults.c: the half of the library that writes, under faults. `write_faults starve FOLDER`, `threads`, `hostile`:
 *
 *     starve   with fault_shim.c preloaded: each allocation fails in turn, and each write, sync, rename and opening of a file
 *     threads  eight threads that pack, rename, gather and save at once (built with ThreadSanitizer)
 *     hostile  tables of NaN, infinities, denormals, huge values and next to nothing (built with AddressSanitizer and UBSan)
 *
 * What fails must say so, hand nothing out, and leave the older archive as it was and nothing beside it; what is packed must load,
 * with values that are finite and not negative.
 */
#include <dlfcn.h>
#include <float.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "brdfpack.h"
#include "scratch.h"

enum { H = 8, D = 7, P = 10, CELLS = H * D * P, VALUES = 3 * CELLS };

static void fail(const char *what, const char *where, long n)
{
	fprintf(stderr, "write_faults: %s (%s, %ld)\n", what, where, n);
	exit(1);
}

static void table_fill(double *values)
{
	for (size_t n = 0; n < VALUES; n++)
		values[n] = n % 11 == 5 ? -1 : 0.2 + (double)(n % 3) + 30 * exp(-0.01 * (double)(n / (3 * D * P)));
}

static bp_measured measured_of(const double *values)
{
	return (bp_measured){.struct_bytes = sizeof(bp_measured),
	                     .theta_h = H,
	                     .theta_d = D,
	                     .phi_d = P,
	                     .number = BP_NUMBER_DOUBLE,
	                     .layout = BP_LAYOUT_INTERLEAVED,
	                     .values = values};
}

struct bytes {
	uint8_t *at;
	size_t count;
};

static int bytes_same(struct bytes a, struct bytes b) { return a.count == b.count && memcmp(a.at, b.at, a.count) == 0; }

/* One thing that is tried again and again: a status, and *out where it is BP_OK. */
struct trial {
	const char *name;
	bp_status (*run)(const struct trial *trial, struct bytes *out, bp_error *error);
	bp_pack_options options;
	const double *values;
	struct bytes record; /* to gather */
	const char *path;
};

static bp_status pack_try(const struct trial *t, struct bytes *out, bp_error *error)
{
	const bp_measured measured = measured_of(t->values);
	return bp_pack(&measured, "a", &t->options, &out->at, &out->count, error);
}

static bp_status rename_try(const struct trial *t, struct bytes *out, bp_error *error)
{
	return bp_record_rename(t->record.at, t->record.count, "another name", &out->at, &out->count, error);
}

/* Into memory, or to the path; the writer must be usable after a failure. */
static bp_status gather_try(const struct trial *t, struct bytes *out, bp_error *error)
{
	bp_writer *writer = NULL;
	bp_status status = bp_writer_create(&writer, error);
	if (!status)
		status = bp_writer_add(writer, t->record.at, t->record.count, error);
	const int added = !status;
	if (!status)
		status = t->path ? bp_writer_save(writer, t->path, error) : bp_writer_save_memory(writer, &out->at, &out->count, error);
	if (added && bp_writer_count(writer) != 1)
		fail("the writer has lost its record", t->name, 0);
	bp_writer_free(writer);
	return status;
}

static struct bytes file_read(const char *path)
{
	struct bytes file = {0};
	FILE *stream = fopen(path, "rb");
	if (!stream || fseek(stream, 0, SEEK_END) != 0)
		fail("the archive is gone", path, 0);
	file.count = (size_t)ftell(stream);
	rewind(stream);
	file.at = malloc(file.count + 1);
	if (!file.at || fread(file.at, 1, file.count, stream) != file.count)
		fail("the archive cannot be read", path, 0);
	fclose(stream);
	return file;
}

/* ---- starve ---- */

typedef void arm_fn(const char *call, long at);
typedef int armed_fn(void);
static arm_fn *fault_arm;
static armed_fn *fault_armed;

/* The n-th call of a kind fails, for n = 1, 2, ... until there are no more. */
static long starve(const struct trial *trial, const char *call, const char *folder)
{
	struct bytes expected = {0}, before = {0};
	bp_error error;
	if (trial->run(trial, &expected, &error))
		fail(error.message, trial->name, 0);
	if (trial->path)
		before = file_read(trial->path);
	for (long n = 1;; n++) {
		struct bytes got = {.count = 12345};
		error = (bp_error){.status = BP_OK};
		fault_arm(call, n);
		const bp_status status = trial->run(trial, &got, &error);
		const int over = fault_armed();
		fault_arm("", 0);
		if (status && (got.at || got.count != 12345 || !error.message[0] || error.status != status))
			fail("a failure hands something out, or says nothing", trial->name, n);
		if (status && status != (call[0] == 'a' ? BP_ERROR_MEMORY : BP_ERROR_IO))
			fail(error.message, trial->name, n);
		if (!status && got.at && !bytes_same(got, expected))
			fail("other bytes", trial->name, n);
		if (trial->path) {
			const struct bytes now = file_read(trial->path);
			if (!bytes_same(now, before) || scratch_count(folder) != 1)
				fail("the folder is not as it was", trial->name, n);
			free(now.at);
		}
		bp_free(got.at);
		if (over) {
			bp_free(expected.at);
			free(before.at);
			return n - 1;
		}
	}
}

static void starve_all(const char *folder)
{
	double values[VALUES];
	char path[4096];
	struct bytes record = {0};
	fault_arm = (arm_fn *)dlsym(RTLD_DEFAULT, "fault_arm");
	fault_armed = (armed_fn *)dlsym(RTLD_DEFAULT, "fault_armed");
	if (!fault_arm || !fault_armed)
		fail("fault_shim is not preloaded", "starve", 0);
	table_fill(values);
	snprintf(path, sizeof path, "%s/out.bpk", folder);
	const struct trial packs[] = {
		{"pack paper", pack_try, {.struct_bytes = sizeof(bp_pack_options), .profile = 1}, values, record, NULL},
		{"pack spectral", pack_try, {.struct_bytes = sizeof(bp_pack_options)}, values, record, NULL},
		{"pack bounded", pack_try, {.struct_bytes = sizeof(bp_pack_options), .max_error = 0.1}, values, record, NULL}};
	if (pack_try(&packs[1], &record, NULL))
		fail("the table cannot be packed", "starve", 0);
	const struct trial rest[] = {{.name = "rename", .run = rename_try, .record = record},
	                             {.name = "to memory", .run = gather_try, .record = record},
	                             {.name = "to a file", .run = gather_try, .record = record, .path = path}};
	for (size_t n = 0; n < 3; n++)
		printf("%s: %ld allocations\n", packs[n].name, starve(&packs[n], "alloc", folder));
	for (size_t n = 0; n < 3; n++)
		printf("%s: %ld allocations\n", rest[n].name, starve(&rest[n], "alloc", folder));
	static const char *const CALLS[] = {"write", "sync", "rename", "open"};
	for (size_t n = 0; n < 4; n++)
		printf("%s: %ld times %s\n", rest[2].name, starve(&rest[2], CALLS[n], folder), CALLS[n]);
	bp_free(record.at);
}

/* ---- threads ---- */

struct thread_job {
	const double *values;
	struct bytes expected[2]; /* records */
	struct bytes archive;
};

static struct bytes pack_plain(const double *values, uint32_t profile)
{
	const struct trial trial = {.options = {.struct_bytes = sizeof(bp_pack_options), .profile = profile}, .values = values};
	struct bytes record = {0};
	bp_error error;
	if (pack_try(&trial, &record, &error))
		fail(error.message, "pack", profile);
	return record;
}

static void *thread_run(void *user)
{
	const struct thread_job *job = user;
	for (int n = 0; n < 4; n++) {
		const uint32_t profile = (uint32_t)(n % 2 + 1);
		struct bytes record = pack_plain(job->values, profile), out = {0};
		if (!bytes_same(record, job->expected[profile - 1]))
			fail("another record in a thread", "threads", n);
		const struct trial gather = {.name = "threads", .record = job->expected[1]};
		if (gather_try(&gather, &out, NULL) || !bytes_same(out, job->archive))
			fail("another archive in a thread", "threads", n);
		bp_free(record.at);
		bp_free(out.at);
	}
	return NULL;
}

static void threads_run(void)
{
	enum { THREADS = 8 };
	double values[VALUES];
	pthread_t thread[THREADS];
	table_fill(values);
	struct thread_job job = {.values = values};
	for (uint32_t profile = 1; profile <= 2; profile++)
		job.expected[profile - 1] = pack_plain(values, profile);
	const struct trial gather = {.name = "threads", .record = job.expected[1]};
	if (gather_try(&gather, &job.archive, NULL))
		fail("the record cannot be gathered", "threads", 0);
	for (int t = 0; t < THREADS; t++)
		if (pthread_create(&thread[t], NULL, thread_run, &job) != 0)
			fail("pthread_create", "threads", t);
	for (int t = 0; t < THREADS; t++)
		pthread_join(thread[t], NULL);
	bp_free(job.expected[0].at);
	bp_free(job.expected[1].at);
	bp_free(job.archive.at);
	printf("threads: 8 threads that pack and save\n");
}

/* ---- hostile ---- */

static double hostile_value(int kind, size_t n)
{
	const size_t cell = n / 3;
	switch (kind) {
	case 0: return NAN;
	case 1: return n % 2 ? INFINITY : -INFINITY;
	case 2: return -1;
	case 3: return cell == 17 ? 1 : -1; /* one cell */
	case 4: return 0;
	case 5: return -0.0;
	case 6: return DBL_TRUE_MIN * (double)(1 + n % 5);
	case 7: return DBL_MAX;
	case 8: return n % 2 ? DBL_MAX : DBL_TRUE_MIN;
	case 9: return n % 3 == 1 ? NAN : 1; /* one channel never measured */
	case 10: return cell % 2 ? 1e300 : 1e-300;
	case 11: return n % 3 == 2 ? 0 : 1e9;
	case 12: return n % 7 == 0 ? NAN : n % 7 == 1 ? INFINITY : n % 7 == 2 ? -INFINITY : n % 7 == 3 ? DBL_MAX : (double)n;
	case 13: return cell < CELLS / 2 ? -1 : 1e30; /* half */
	case 14: return (double)FLT_MAX * (1 + (double)n);
	default: return (double)(float)FLT_TRUE_MIN;
	}
}

static void record_loads(struct bytes record, int kind)
{
	const struct trial gather = {.name = "hostile", .record = record};
	struct bytes out = {0};
	bp_archive *archive = NULL;
	bp_error error;
	if (gather_try(&gather, &out, &error) || bp_archive_open_memory(out.at, out.count, &archive, &error) ||
	    bp_archive_verify(archive, BP_VERIFY_DEEP, NULL, NULL, &error))
		fail(error.message, "hostile", kind);
	for (int form = 0; form < 3; form++) {
		const bp_load_options options = {.struct_bytes = sizeof options, .form = (bp_form)form, .sampling = 1};
		const float wi[3] = {0.1f, 0.6f, 0.8f}, wo[3] = {0.28f, 0, 0.96f}, u[3] = {0.3f, 0.6f, 0.9f};
		float rgb[3], drawn[3];
		bp_material *material = NULL;
		if (bp_material_load(archive, 0, &options, &material, &error))
			fail(error.message, "hostile", kind);
		bp_material_evaluate(material, wi, wo, rgb);
		for (int c = 0; c < 3; c++)
			if (!(rgb[c] >= 0 && rgb[c] <= FLT_MAX))
				fail("a value that is none", "hostile", kind);
		if (!(bp_material_sample(material, wo, u, drawn) >= 0))
			fail("a density that is none", "hostile", kind);
		bp_material_free(material);
	}
	bp_archive_close(archive);
	bp_free(out.at);
}

static void hostile_run(void)
{
	double values[VALUES];
	int packed = 0, refused = 0;
	for (int kind = 0; kind < 16; kind++)
		for (uint32_t profile = 1; profile <= 2; profile++)
			for (int tiny = 0; tiny < 2; tiny++) {
				const bp_pack_options options = {.struct_bytes = sizeof options, .profile = profile};
				bp_measured measured = measured_of(values);
				struct bytes record = {0};
				bp_error error = {.status = BP_OK};
				if (tiny)
					measured.theta_h = measured.theta_d = measured.phi_d = 4;
				for (size_t n = 0; n < VALUES; n++)
					values[n] = hostile_value(kind, n);
				const bp_status status = bp_pack(&measured, "a", &options, &record.at, &record.count, &error);
				if (status && (status != BP_ERROR_BAD_INPUT || record.at || !error.message[0]))
					fail(error.message, "hostile", kind);
				if (!status)
					record_loads(record, kind);
				bp_free(record.at);
				*(status ? &refused : &packed) += 1;
			}
	printf("hostile: %d tables packed, %d refused\n", packed, refused);
}

int main(int argc, char **argv)
{
	if (argc == 3 && !strcmp(argv[1], "starve")) {
		starve_all(argv[2]);
	} else if (argc == 2 && !strcmp(argv[1], "threads")) {
		threads_run();
	} else if (argc == 2 && !strcmp(argv[1], "hostile")) {
		hostile_run();
	} else {
		fprintf(stderr, "usage: write_faults starve FOLDER | threads | hostile\n");
		return 2;
	}
	return 0;
}
